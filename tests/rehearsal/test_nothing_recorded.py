"""A run that ended before its first tick was over says why."""

import pytest

from laglab.errors import RunError
from laglab.results.complete import Manner, keep
from laglab.runs.ending import Ending
from laglab.scenario import load
from laglab_gateway import MemoryRecorder, Outcome
from laglab_protocol import EndReason


@pytest.mark.parametrize(
    ("reason", "said"),
    [
        (EndReason.DISPLACED, "another station has the robot"),
        (EndReason.FAILED, "the other side failed before"),
        (EndReason.COMPLETED, "ended before its first tick was over"),
    ],
)
def test_who_ended_it_is_named(reason: EndReason, said: str) -> None:
    ending = Ending(Outcome(reason, 0))
    with pytest.raises(RunError, match=said):
        keep(load("lab"), Manner(), ending, MemoryRecorder())
