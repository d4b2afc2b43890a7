"""A rover in a process of its own, for other people's programs to find."""

import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from .asked import Asked


@pytest.fixture
def port() -> int:
    """A UDP port of loopback that was free a moment ago."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        free: int = probe.getsockname()[1]
    return free


@pytest.fixture
def rover(port: int, tmp_path: Path) -> Iterator[Asked]:
    """Calls at `port`, as robots call their ground station; what it is asked there."""
    script, log = Path(__file__).parent / "rover.py", tmp_path / "asked.jsonl"
    command = [sys.executable, script, f"udpout://127.0.0.1:{port}", log]
    with subprocess.Popen(command) as process:
        yield Asked(log)
        assert process.poll() is None, "the rover died"
        process.kill()
