"""Memory does not grow with a run's length, while it lasts and when its results are made."""

import sys
import tracemalloc
from array import array
from collections import deque
from collections.abc import Callable, Iterable
from contextlib import closing
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace

from laglab.export.ros import stream
from laglab.export.ros.stream import said
from laglab.export.tables import tables
from laglab.results import columns
from laglab.results import run as results
from laglab.results.digest import digest
from laglab.results.run import Run, open_run
from laglab.runs.rehearse import rehearse_inline
from laglab.scenario import load
from laglab_gateway import FileRecorder, Recorder, Tapped, TraceRow
from laglab_protocol import EndReason

Rehearsed = Callable[..., object]
Read = Callable[[Run], Iterable[object]]

SETTLED = 2000
"""Ticks after which every window of the two sides is full."""
SWINGS = 4000
"""Ticks in which all that is cut back now and then has been cut back more than once."""
ROWS = (2_000, 8_000)
AT_A_TIME = 500
LOSSY = {"link.command.loss": 0.02, "link.measurement.loss": 0.02}


class Meter(Recorder):
    """Notes how many pieces of memory Python's objects take at each tick."""

    def __init__(self) -> None:
        self.blocks = array("q")  # a list would grow by a number a tick

    def row(self, row: TraceRow) -> None:  # noqa: ARG002 it is kept elsewhere
        self.blocks.append(sys.getallocatedblocks())


@pytest.mark.slow
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
    monkeypatch.setattr(results, "MOST_DRAWN", 100)
    run = open_run(tmp_path / "run")
    short, long = (traced(partial(shown, lengthened(run, rows))) for rows in ROWS)
    assert long < 1.1 * short


@pytest.fixture(autouse=True)
def small_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    """So that a run of a few of them is long already."""
    monkeypatch.setattr(columns, "AT_A_TIME", AT_A_TIME)
    monkeypatch.setattr(results, "trace_pieces", partial(results.trace_pieces, most=AT_A_TIME))


def ticks(run: Run) -> Iterable[object]:
    """The exported table."""
    return tables(run).ticks.pieces


@pytest.mark.slow
@pytest.mark.parametrize("read", [ticks, said])
def test_exports_never_hold_the_whole_run(
    read: Read,
    tmp_path: Path,
    rehearsed: Rehearsed,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rehearsed("lab", "--duration", "1", "--estimator", "delayed-ekf", "--estimator", "ekf")
    monkeypatch.setattr(stream, "LATEST", AT_A_TIME)
    run = open_run(tmp_path / "run")
    short, long = (traced(partial(consumed, read, lengthened(run, rows))) for rows in ROWS)
    assert long < 1.1 * short


def lengthened(run: Run, rows: int) -> Run:
    """With the last row of each of its tables again and again, at later times, until there are so
    many."""
    assert run.directory is not None
    for path in run.directory.glob("*.csv"):
        kept = path.read_text().splitlines(keepends=True)
        names, last = kept[0].strip().split(","), kept[-1].strip().split(",")
        first = int(last[names.index("tick")]) + 1
        for tick in range(first, first + rows - len(kept) + 1):
            moved = {"tick": tick, "arrived": tick, "time": tick / 100}
            cells = zip(names, last, strict=True)
            kept.append(",".join(str(moved.get(name, cell)) for name, cell in cells) + "\n")
        path.write_text("".join(kept))
    return Run(run.scenario, replace(run.summary, ticks=rows - 1), run.directory)


def traced(work: Callable[[], object]) -> int:
    """The most memory that it takes [bytes]."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def consumed(read: Read, run: Run) -> None:
    """All that it gives, and nothing of it kept."""
    deque(read(run), 0)


def shown(run: Run) -> None:
    """Its numbers, and its picture's rows."""
    digest(run.pieces(), run.scenario.link.measurement_delay)
    assert run.drawn
