"""Nothing grows, however often a robot is started."""

import gc
import os
import sys
import tempfile
from pathlib import Path

import pytest

from laglab_fmu import Robot, RobotParameters

PROCESS = Path("/proc/self")
KILOBYTE = 1024
pytestmark = pytest.mark.skipif(not PROCESS.is_dir(), reason="counts by /proc")


def resident() -> int:
    """Bytes of memory in use."""
    gc.collect()
    return int((PROCESS / "statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def handles() -> int:
    return len(list((PROCESS / "fd").iterdir()))


def mappings() -> int:
    """Parts of memory that are mapped, each loaded library being several."""
    return len((PROCESS / "maps").read_text().splitlines())


def open_and_close(version: int, runs: int) -> None:
    for seed in range(runs):
        with Robot.open(version, RobotParameters(seed=seed)) as robot:
            robot.step(1.0, 2.0)


@pytest.mark.slow
@pytest.mark.parametrize("version", [2, 3])
def test_opening_and_closing(version: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """After a start in which the interpreter's own pools fill."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    open_and_close(version, 150)
    before = resident(), handles(), mappings()
    open_and_close(version, 350)
    assert (resident() - before[0]) / 350 < 4 * KILOBYTE
    assert handles() == before[1]
    assert abs(mappings() - before[2]) < 20
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("version", [2, 3])
def test_ten_thousand_runs_by_reset(version: int) -> None:
    with Robot.open(version, RobotParameters()) as robot:
        first = robot.step(1.0, 2.0)
        for _ in range(1000):
            robot.reset(RobotParameters())
        before = resident(), handles(), sys.getallocatedblocks()
        for seed in range(10_000):
            robot.reset(RobotParameters(seed=seed))
            robot.step(1.0, 2.0)
        assert (resident() - before[0]) / 10_000 < 100
        assert handles() == before[1]
        assert abs(sys.getallocatedblocks() - before[2]) < 1000
        robot.reset(RobotParameters())
        assert robot.step(1.0, 2.0) == first
