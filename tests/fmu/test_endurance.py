"""Nothing grows, however often a robot is started."""

import ctypes
import gc
import sys
import tempfile
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import pytest

from laglab_fmu import Robot, RobotParameters

PROCESS = Path("/proc/self")


class Heap(ctypes.Structure):
    """What glibc's mallinfo2 gives; `uordblks` is the bytes in use."""

    _fields_ = [
        *((f"not_needed_{i}", ctypes.c_size_t) for i in range(7)),
        ("uordblks", ctypes.c_size_t),
        *((f"nor_needed_{i}", ctypes.c_size_t) for i in range(2)),
    ]


C_LIBRARY = ctypes.CDLL(None) if PROCESS.is_dir() else None
pytestmark = pytest.mark.skipif(not hasattr(C_LIBRARY, "mallinfo2"), reason="counts by glibc")


class Use(NamedTuple):
    """What this process holds."""

    heap: int
    blocks: int
    handles: int
    mappings: int


def use() -> Use:
    gc.collect()
    mallinfo = C_LIBRARY.mallinfo2  # type: ignore[union-attr]
    mallinfo.restype = Heap
    return Use(
        heap=mallinfo().uordblks,
        blocks=sys.getallocatedblocks(),
        handles=len(list((PROCESS / "fd").iterdir())),
        mappings=len((PROCESS / "maps").read_text().splitlines()),
    )


def open_and_close(version: int, runs: int) -> None:
    for seed in range(runs):
        with Robot.open(version, RobotParameters(seed=seed)) as robot:
            robot.step(1.0, 2.0)


@pytest.mark.slow
@pytest.mark.parametrize("version", [2, 3])
def test_opening_and_closing(version: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """One instance is some 500 bytes of C heap; a robot kept alive, many Python blocks. Heap that
    leaks does so each time; somebody else's buffer in this process comes once."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    runs, turns = 100, 3
    open_and_close(version, runs)
    uses = [use()]
    for _ in range(turns):
        open_and_close(version, runs)
        uses.append(use())
    before, after = uses[0], uses[-1]
    assert min(later.heap - earlier.heap for earlier, later in pairwise(uses)) / runs < 200
    assert (after.blocks - before.blocks) / (turns * runs) < 2
    assert after.handles == before.handles
    assert abs(after.mappings - before.mappings) < 20
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("version", [2, 3])
def test_ten_thousand_runs_by_reset(version: int) -> None:
    runs = 10_000
    with Robot.open(version, RobotParameters()) as robot:
        first = robot.step(1.0, 2.0)
        for _ in range(500):
            robot.reset(RobotParameters())
        before = use()
        for seed in range(runs):
            robot.reset(RobotParameters(seed=seed))
            robot.step(1.0, 2.0)
        after = use()
        assert (after.heap - before.heap) / runs < 5
        assert (after.blocks - before.blocks) / runs < 0.1
        assert after.handles == before.handles
        robot.reset(RobotParameters())
        assert robot.step(1.0, 2.0) == first
