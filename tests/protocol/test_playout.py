"""Play-out gives out everything at the same age, or not at all."""

from typing import NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_protocol import Playout


class Stamped(NamedTuple):
    tick: int
    name: int = 0


@given(st.lists(st.tuples(st.integers(0, 30), st.integers(0, 40))), st.integers(1, 20))
def test_all_are_as_old_as_the_bound_and_none_that_came_in_time_is_missing(
    sent: list[tuple[int, int]], bound: int
) -> None:
    playout = Playout[Stamped](bound)
    given_out: list[Stamped] = []
    late: list[Stamped] = []
    for tick in range(100):
        came = [Stamped(stamp) for stamp, delay in sent if stamp + delay == tick]
        late += playout.take(tick, came)
        due = playout.due(tick)
        assert {message.tick for message in due} <= {tick - bound}
        given_out += due
    in_time = sorted(stamp for stamp, delay in sent if delay <= bound)
    assert [message.tick for message in given_out] == in_time
    assert len(late) == len(sent) - len(in_time)


def test_of_the_same_stamp_the_first_to_come_goes_first() -> None:
    playout = Playout[Stamped](3)
    playout.take(1, [Stamped(0, 1)])
    playout.take(2, [Stamped(0, 2)])
    assert playout.due(2) == []
    assert playout.due(4) == [Stamped(0, 1), Stamped(0, 2)]  # a tick that was passed over, too


def test_a_play_out_of_nothing_is_refused() -> None:
    with pytest.raises(ValueError, match="1 or more"):
        Playout[Stamped](0)
