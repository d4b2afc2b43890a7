"""A link is measured: the cores, in a world of numbers."""

import heapq
import math
from collections.abc import Callable

import numpy as np
import pytest

from laglab.link.measured import bursts
from laglab.link.probing import Clocks, Prober, Sizes, seen_by_clocks
from laglab.link.probing.clocks import ClockTimes, lowest_line
from laglab.link.probing.ends import Answerer
from laglab.link.probing.probe import hidden_arrivals
from laglab.link.probing.sizes import overload
from laglab_protocol import NO_PROBE, PROBE_FILLER, PROBE_LAGS, Probe

FILLER = (1,) * 7 + (0,) * (PROBE_FILLER - 7)


INTERVAL_US = 10_000


AHEAD_NS = 1_700_000_000_000_000_000
"""By which the robot's clock is ahead of the station's."""


def asked(session: int = 1, number: int = 0, interval_us: int = INTERVAL_US) -> Probe:
    """What a prober says that has heard nothing yet."""
    return Probe(0, (0, 0, 0), session, number, interval_us, (NO_PROBE,) * 3, FILLER)


def crossed(
    count: int,
    up: Callable[[int], int | None],
    down: Callable[[int], int | None],
    until: float = math.inf,
) -> Clocks:
    """The two ends in a world without time: frame number i takes up(i), down(i) ns, None: lost.
    After `until` [ns] the measurement is cut short."""
    prober, echo = Prober(7, count, INTERVAL_US, FILLER), Answerer(FILLER)
    flying: list[tuple[int, int, bool, Probe]] = []
    now, due = 0, 0
    while not prober.is_done(now) and now < until:
        if now >= due:
            said = prober.say(now)
            due += INTERVAL_US * 1000
            if (took := up(said.sequence)) is not None:
                heapq.heappush(flying, (now + took, said.sequence, True, said))
        while flying and flying[0][0] <= now:
            came, _, upwards, said = heapq.heappop(flying)
            if upwards:
                echo.hear(said, came + AHEAD_NS)
            else:
                prober.hear(said, came)
        while (answer := echo.say(now + AHEAD_NS)) is not None:
            if (took := down(answer.sequence)) is not None:
                heapq.heappush(flying, (now + took, answer.sequence, False, answer))
        now += 500_000
    if now >= until:
        prober.cut(now)
    return seen_by_clocks(*prober.times(), None)


def test_every_frame_is_accounted_for_though_some_are_lost_each_way() -> None:
    rng = np.random.default_rng(5)
    lost = rng.random((2, 4000)) < 0.05
    lost[1, 100:130] = True  # a gap in what is told
    late = rng.integers(0, 20, (2, 4000)) * 500_000
    late[:, 7::50] = 0
    seen = crossed(
        600,
        lambda i: None if lost[0, i] else 12_000_000 + int(late[0, i]),
        lambda i: None if lost[1, i] else 8_000_000 + int(late[1, i]),
    )
    for name, delays, gone, took in (
        ("up", seen.ours, lost[0, :600], late[0, :600]),
        ("down", seen.theirs, lost[1, :600], late[1, :600]),
    ):
        np.testing.assert_array_equal(np.isnan(delays), gone, name)
        # Half of the shortest round trip stands for the fastest frame each way.
        np.testing.assert_allclose(delays[~gone], 0.010 + 1e-9 * took[~gone], atol=6e-4)
    assert "20 ms" in seen.note
    assert "not known to agree" in seen.note


@pytest.mark.parametrize("count", [300, 900], ids=["near its end", "long before"])
@pytest.mark.parametrize("back", [200, 900], ids=["the far end", "the way there"])
def test_a_link_that_dies_ends_the_measurement(count: int, back: int) -> None:
    seen = crossed(
        count,
        lambda i: 1_000_000 if i < 200 else None,
        lambda i: 1_000_000 if i < back else None,
    )
    assert np.isnan(seen.ours).nonzero()[0].tolist() == list(range(200, count))
    assert hidden_arrivals(seen) == 0, "nobody was there"


def test_what_is_under_way_when_it_is_cut_short_does_not_count_as_lost() -> None:
    seen = crossed(600, lambda _: 30_000_000, lambda _: 20_000_000, until=2_000_000_000)
    assert 193 <= len(seen.ours) == len(seen.theirs) < 200
    assert not np.isnan(np.concatenate([seen.ours, seen.theirs])).any()
    silent = crossed(600, lambda i: 1_000_000 if i < 99 else None, lambda _: 1_000_000, 2e9)
    assert np.isnan(silent.ours).nonzero()[0].tolist() == list(range(99, len(silent.ours)))
    assert len(silent.ours) > 195, "of those that had had their time it is known that they are lost"


def test_clocks_that_drift_are_taken_apart() -> None:
    rng = np.random.default_rng(2)
    sent = 0.01 * np.arange(6000.0)
    jitter = rng.exponential(0.004, (2, 6000))
    ahead = -3.0 + 80e-6 * sent  # the second clock gains 5 ms in a minute
    seen = seen_by_clocks(
        ClockTimes(sent, 0.02 + jitter[0] + ahead), ClockTimes(sent, 0.02 + jitter[1] - ahead), None
    )
    np.testing.assert_allclose(seen.ours, 0.02 + jitter[0], atol=1e-4)
    np.testing.assert_allclose(seen.theirs, 0.02 + jitter[1], atol=1e-4)


def test_clocks_that_agree_give_one_way_delays_and_those_that_do_not_are_found_out() -> None:
    there = ClockTimes(np.array([0.0, 0.01]), np.array([0.003, np.nan]))
    back = ClockTimes(np.array([0.0, 0.01]), np.array([0.009, 0.011]))
    seen = seen_by_clocks(there, back, 0.001)
    np.testing.assert_array_equal(seen.ours, [0.003, np.nan])
    np.testing.assert_array_equal(seen.theirs, [0.009, 0.011])
    assert "one-way" in seen.note
    off = ClockTimes(there.sent, there.apart - 0.005)
    found = seen_by_clocks(off, back, 0.001)
    assert "a frame came 2 ms before it was sent" in found.note
    np.testing.assert_allclose(found.ours[0], 0.0035)


def test_what_nothing_came_of_has_no_delay() -> None:
    nothing, back = (ClockTimes.of([0, 10], [None, None]), ClockTimes.of([0, 10], [5, 20]))
    assert lowest_line(nothing) is None
    assert np.isnan(seen_by_clocks(nothing, back, None).theirs).all()


def test_bursts_are_counted() -> None:
    assert bursts(np.array([True, False, True, True, False])) == [1, 2]
    assert bursts(np.array([False])) == []


def test_an_answer_that_comes_twice_counts_once_and_when_it_came_first() -> None:
    prober = Prober(7, 2, INTERVAL_US, FILLER)
    for number in range(2):
        prober.say(number * INTERVAL_US * 1000)
    answer = Probe(5, (0, 0, 0), 7, 0, INTERVAL_US, (NO_PROBE,) * 3, FILLER)
    for now in (12_000_000, 19_000_000):
        prober.hear(answer, now)
    assert prober.answered == 1
    _, theirs = prober.times()
    assert theirs.apart[0] == pytest.approx(12e-3 - 5e-9)


def test_an_end_that_hears_nothing_tells_of_nothing_and_is_forgotten() -> None:
    echo = Answerer(FILLER)
    assert echo.say(0) is None
    assert echo.hear(asked(number=5, interval_us=10), 0)
    assert echo.end is not None
    assert echo.end.interval_us == 1000, "no more than a thousand a second"
    said = echo.say(0)
    assert said is not None
    assert said.came == (5, NO_PROBE, NO_PROBE)
    assert echo.take_over(10**9 - 1) is None
    assert echo.take_over(10**9) is not None
    assert echo.say(10**10) is None


def test_who_measures_slowly_is_not_forgotten_in_between() -> None:
    echo = Answerer(FILLER)
    echo.hear(asked(interval_us=2_000_000), 0)
    assert echo.take_over(6 * 10**9 - 1) is None
    assert echo.take_over(6 * 10**9) is not None
    echo.hear(asked(interval_us=2**32 - 1), 0)
    assert echo.take_over(30 * 10**9) is not None, "nobody keeps it for an hour"


def test_a_line_that_carries_less_than_a_run_says_is_told() -> None:
    sizes = Sizes(121, 75)
    said = overload("serial:///dev/ttyUSB0:57600", sizes, 0.01)
    assert said is not None
    assert "57600 baud carry less than the 121000" in said
    for url in ("serial:///dev/ttyUSB0:230400", "/dev/ttyUSB0,230400", "udpout://1.2.3.4:9"):
        assert overload(url, sizes, 0.01) is None
    assert overload("/dev/ttyUSB0,57600", sizes, 0.01) is not None


def test_who_measures_is_not_disturbed_by_another() -> None:
    echo, last = Answerer(FILLER), 2**32 - 1
    assert echo.is_for(asked(last), 0)
    echo.hear(asked(last), 0)
    assert echo.is_for(asked(last), 1)
    assert echo.is_for(asked(0), 1), "the next one is the same measurer's"
    assert not echo.is_for(asked(1), 1)
    assert echo.is_for(asked(1), 10**9)


def test_a_measurer_begins_once_though_it_calls_before_it_measures() -> None:
    echo, last = Answerer(FILLER), 2**32 - 1
    assert [echo.hear(asked(session), 0) for session in (last, last, 0, 0, 9)] == [
        *(True, False, False, False),
        True,  # somebody else, whose turn it is
    ]


def test_arrivals_of_which_nothing_tells_are_estimated() -> None:
    rng = np.random.default_rng(1)
    lost = rng.random((2, 9000)) < 0.3
    seen = crossed(
        2000,
        lambda i: None if lost[0, i] else 10_000_000,
        lambda i: None if lost[1, i] else 10_000_000,
    )
    hidden = int(np.isnan(seen.ours).sum() - lost[0, :2000].sum())
    assert hidden > 10
    assert hidden_arrivals(seen) == pytest.approx(hidden, rel=0.5)
    assert hidden_arrivals(Clocks(np.zeros(9), np.zeros(9), "")) == 0
    assert hidden_arrivals(Clocks(np.full(9, np.nan), np.zeros(0), "")) == 0


def test_losses_each_by_itself_are_told_of_as_if_there_had_been_no_silence() -> None:
    rng = np.random.default_rng(3)
    came = np.where(rng.random(4000) < 0.3, np.nan, 0.01)
    came[-1] = 0.01
    lost = np.isnan(came).mean() ** 3
    steady = hidden_arrivals(Clocks(np.zeros(4000), came, ""))
    assert steady == pytest.approx(4000 * lost / (1 - lost))
    silence = np.full(PROBE_LAGS[-1] + 1, np.nan)
    interrupted = np.concatenate([[0.01], came[:2000], [0.01], silence, [0.01], came[2000:]])
    seen = Clocks(np.where(np.isnan(interrupted), np.nan, 0.01), interrupted, "")
    assert hidden_arrivals(seen) == pytest.approx(0.7 * steady, rel=0.02)
