"""``laglab bench filter``: every contender does the work that is timed."""

from laglab.bench.filter import FILTERPY, OURS, controllers, filters, make_drive, timings


def test_every_contender_is_timed_at_every_delay():
    rows = list(timings(filters(), delays=(0, 3), ticks=20, rounds=1))
    names = {row.name for row in rows}
    assert names > {*OURS, FILTERPY}
    assert all(0 < cost < 1e5 for row in rows for cost in row.by_delay.values())


def test_the_whole_controller_too():
    drive = make_drive(20)
    assert all(turn(drive, m) > 0 for turn in controllers().values() for m in (0, 3))


def test_the_command_prints_both_tables(laglab):
    ended = laglab("bench", "filter", "--ticks", "10", "--rounds", "1")
    assert ended.returncode == 0, ended.stderr
    assert "the filter alone" in ended.stdout
    assert "extrapolation over n = m ticks" in ended.stdout
