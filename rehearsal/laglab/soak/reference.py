"""The same run in one process, with nothing between the sides and nobody near."""

import subprocess
import sys
from pathlib import Path

from laglab_gateway import TRACE_FILE


def fault_of_trace(trace: Path, scenario: Path, folder: Path) -> str:
    """In what a run's `trace.csv` is not the one inline, which is made in `folder`; empty when it
    is."""
    if not trace.exists():
        return f"there is no {trace.name}"
    options = ("--transport", "inline", "--set", "estimator.compare=[]", "--out", str(folder))
    done = subprocess.run(
        [sys.executable, "-P", "-m", "laglab", "run", str(scenario), *options],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    inline = folder / TRACE_FILE
    if not inline.exists():
        return f"the same run inline left none, and ended with {done.returncode}: {done.stderr}"
    same = trace.read_bytes() == inline.read_bytes()
    return "" if same else "trace.csv is not the one of the same run inline"
