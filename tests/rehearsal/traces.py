"""The trace of a run that goes on, or was ended somehow."""

import time
from pathlib import Path

from laglab_gateway import read_trace


def wait_for_rows(trace: Path, rows: int = 50) -> None:
    while not trace.exists() or trace.read_bytes().count(b"\n") <= rows:
        time.sleep(0.02)


def assert_whole(trace: Path) -> None:
    """Up to its last row."""
    assert trace.read_text().endswith("\n")
    ticks = read_trace(trace)["tick"]
    assert ticks.tolist() == list(range(len(ticks)))
