"""Memory does not grow with a run's length, while it lasts and when its results are made."""

import sys
import tracemalloc
from array import array
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace

from laglab.results import run as results
from laglab.results.digest import digest
from laglab.results.run import Run, open_run
from laglab.runs.rehearse import rehearse_inline
from laglab.scenario import load
from laglab_gateway import TRACE_FILE, FileRecorder, Recorder, Tapped, TraceRow
from laglab_protocol import EndReason

Rehearsed = Callable[..., object]

SETTLED = 2000
"""Ticks after which every window of the two sides is full."""
SWINGS = 4000
"""Ticks in which all that is cut back now and then has been, more than once."""
LOSSY = {"link.command.loss": 0.02, "link.measurement.loss": 0.02}


class Meter(Recorder):
    """Notes how many pieces of memory Python's objects take at each tick."""

    def __init__(self) -> None:
        self.blocks = array("q")  # a list would grow by a number a tick

    def row(self, row: TraceRow) -> None:  # noqa: ARG002 it is kept elsewhere
        self.blocks.append(sys.getallocatedblocks())


@pytest.mark.parametrize("link", [{}, LOSSY], ids=["ideal", "lossy"])
def test_a_run_of_any_length_takes_the_same_memory(link: dict[str, float], tmp_path: Path) -> None:
    ticks, meter = SETTLED + 2 * SWINGS, Meter()
    scenario = load("lab", {"estimator.kind": "popf", "duration": ticks * 0.01, **link})
    with closing(FileRecorder(tmp_path)) as files:
        ending = rehearse_inline(scenario, Tapped(files, meter))
    assert ending.outcome == (EndReason.COMPLETED, ticks)
    earlier, later = np.split(np.array(meter.blocks[SETTLED + 1 :]), 2)
    assert later.max() < earlier.max() + SWINGS / 2  # less than an object every other tick


def test_results_never_hold_the_whole_trace(
    tmp_path: Path, rehearsed: Rehearsed, monkeypatch: pytest.MonkeyPatch
) -> None:
    rehearsed("lab", "--duration", "1")
    monkeypatch.setattr(results, "MOST_DRAWN", 1000)
    short, long = (peak(lengthened(open_run(tmp_path / "run"), rows)) for rows in (10_000, 30_000))
    assert long < 1.1 * short


def lengthened(run: Run, rows: int) -> Run:
    """With its last row again and again, at later times, until there are so many."""
    assert run.directory is not None
    path = run.directory / TRACE_FILE
    kept = path.read_text().splitlines(keepends=True)
    cells = kept[-1].split(",", 2)[-1]
    more = [f"{tick},{tick / 100},{cells}" for tick in range(len(kept) - 1, rows)]
    path.write_text("".join(kept + more))
    return Run(run.scenario, replace(run.summary, ticks=rows - 1), run.directory)


def peak(run: Run) -> int:
    """The most memory that its numbers and its picture's rows take [bytes]."""
    tracemalloc.start()
    try:
        digest(run.pieces(), run.scenario.link.measurement_delay)
        assert run.drawn
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
