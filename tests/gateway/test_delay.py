"""The delay line: exact for every delay, 0 included."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_gateway import DelayLine


@given(delay=st.integers(0, 50), ticks=st.integers(1, 120))
def test_every_item_comes_out_exactly_delay_ticks_later(delay: int, ticks: int) -> None:
    line: DelayLine[int] = DelayLine(delay)
    for tick in range(ticks):
        line.push(tick, tick)
        assert line.due(tick) == ([tick - delay] if tick >= delay else [])


def test_what_was_not_taken_in_time_comes_out_late_and_in_order() -> None:
    line: DelayLine[str] = DelayLine(1)
    line.push(0, "first")
    line.push(1, "second")
    assert line.due(5) == ["first", "second"]


def test_a_negative_delay_is_refused() -> None:
    with pytest.raises(ValueError, match="0 or more"):
        DelayLine(-1)
