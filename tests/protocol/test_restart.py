"""What of a robot's old ticks shows that it has begun again."""

from laglab_protocol.restart import OLD, SAME, Restart

NEWEST = 100


def test_an_old_tick_that_comes_again_and_again_shows_it() -> None:
    watch = Restart()
    assert [watch.shows(3, NEWEST) for _ in range(SAME)] == [False] * (SAME - 1) + [True]


def test_old_ticks_in_order_show_it() -> None:
    watch = Restart()
    assert [watch.shows(tick, NEWEST) for tick in range(OLD)] == [False] * (OLD - 1) + [True]


def test_a_newer_tick_in_between_shows_that_it_goes_on() -> None:
    watch = Restart()
    for newest in range(NEWEST, NEWEST + 40):
        assert not any(watch.shows(3, newest) for _ in range(SAME - 1))
        assert not watch.shows(newest + 1, newest)


def test_old_ticks_out_of_order_only_come_late() -> None:
    watch = Restart()
    assert not any(watch.shows(tick, NEWEST) for tick in reversed(range(60)))
