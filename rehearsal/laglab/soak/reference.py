"""The same run in one process, with nothing between the sides and nobody near."""

import subprocess
import sys
from pathlib import Path

from laglab_gateway import TRACE_FILE


def inline_trace(scenario: Path, folder: Path) -> bytes:
    """Its `trace.csv`; empty when there is none."""
    options = ("--transport", "inline", "--set", "estimator.compare=[]", "--out", str(folder))
    subprocess.run(
        [sys.executable, "-P", "-m", "laglab", "run", str(scenario), *options],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        check=False,
    )
    trace = folder / TRACE_FILE
    return trace.read_bytes() if trace.exists() else b""
