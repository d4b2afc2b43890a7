"""Pings, and clocks compared."""

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_gateway import Safety, Services, Timesyncing, standard_parameters
from laglab_protocol import (
    Ping,
    Timesync,
)

from .asking import GCS, ask


def test_a_ping_is_answered_and_an_answer_is_not(services: Services) -> None:
    assert ask(services, Ping(7, 8, 0, 0)) == [Ping(7, 8, *GCS)]
    assert ask(services, Ping(7, 8, 1, 1)) == []


def test_in_simulated_time_clocks_are_not_compared(services: Services) -> None:
    assert ask(services, Timesync(0, 123)) == []


def test_a_question_of_time_is_answered() -> None:
    services = Services(standard_parameters(0, 0, Safety()), timesync=Timesyncing(lambda: 1000))

    assert ask(services, Timesync(0, 123)) == [Timesync(1000, 123)]


@given(st.integers(-(10**15), 10**15), st.integers(0, 10**9), st.integers(0, 10**9))
def test_offset_and_round_trip(offset: int, there: int, back: int) -> None:
    """A peer whose clock is ahead, at the end of a line of equal delays, is measured exactly."""
    start = 5 * 10**15
    times = iter([start, start + there + back])
    ours = Timesyncing(lambda: next(times))
    question = ours.ask()
    (answer,) = Timesyncing(lambda: start + there + offset).answer(question)
    assert isinstance(answer, Timesync)
    ours.answer(answer)

    found = ours.report()
    assert found is not None
    assert found.samples == 1
    assert found.round_trip_p50_s == pytest.approx((there + back) * 1e-9, rel=1e-3, abs=1.1e-9)
    assert abs(found.offset_s * 1e9 - offset) <= abs(there - back) / 2 + 2


def test_an_answer_to_another_question_is_no_sample() -> None:
    times = itertools.count(1000)
    ours = Timesyncing(lambda: next(times))
    ours.ask()
    ours.answer(Timesync(5, 77))

    assert ours.report() is None
