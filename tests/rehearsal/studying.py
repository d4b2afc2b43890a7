"""What the tests of studies share: a small study, and its results as they are to be."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from laglab.studies.sweep.cells.tasks import Task, done
from laglab.studies.sweep.loading import load_study
from laglab.version import code_version

SMALL = """
scenario = "lab"
seeds = 3

[grid]
"link.command_delay" = [0, 2, 4, 6, 8, 10, 12, 14]
"estimator.kind" = ["popf", "delayed-ekf"]

[start]
radius = 5.0
"""
SEEDS = 3
CELLS = 16
DURATION = 1.0
SHORT = ("--set", f"duration={DURATION}")
DEADLY = """
import os

from laglab_control import Ekf

class Deadly(Ekf):
    def __init__(self, model, at=0):
        super().__init__(model)
        self.at = at
    def predict(self, state, u):
        self.at -= 1
        if self.at == 0:
            os._exit(3)
        return super().predict(state, u)
"""
MORTAL = """
scenario = "lab"
[grid]
duration = [0.2]
"link.command_delay" = [0, 1]
"estimator.kind" = ["own:Deadly"]
"estimator.options.at" = [10, 500]
"""

Contents = dict[str, bytes]
Marks = dict[str, tuple[int, int]]


def undisturbed(path: Path) -> Contents:
    """Every cell's file, computed here, one after the other."""
    cells = tuple(load_study(str(path), {"duration": DURATION}).cells())
    contents = done(Task(cells, code_version()))
    return {f"{cell.key}.parquet": each for cell, each in zip(cells, contents, strict=True)}


def write_deadly_study(folder: Path) -> None:
    """`mortal.toml`: two of its four runs end whoever makes them."""
    (folder / "own.py").write_text(DEADLY)
    (folder / "mortal.toml").write_text(MORTAL)


def there(folder: Path) -> Marks:
    """The cells that are there: whoever writes one again gives it another inode or time."""
    found = {}
    for path in folder.glob("cells/*.parquet"):
        status = path.stat()
        found[path.name] = (status.st_ino, status.st_mtime_ns)
    return found


def contents(folder: Path) -> Contents:
    """All that lies beside the cells, too: nothing should."""
    return {path.name: path.read_bytes() for path in (folder / "cells").iterdir()}


def wait_for_cells(folder: Path, count: int, patience: float = 90.0) -> None:
    """Until so many are there."""
    deadline = time.monotonic() + patience
    while len(there(folder)) < count:
        assert time.monotonic() < deadline, f"{len(there(folder))} cells, not {count}"
        time.sleep(0.01)


@contextmanager
def nothing_again(folder: Path) -> Iterator[None]:
    """What is there before is the same file afterwards."""
    before = there(folder)
    yield
    after = there(folder)
    assert {name: after.get(name) for name in before} == before
