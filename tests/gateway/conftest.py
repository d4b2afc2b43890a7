"""A rover in a process of its own, for the programs of others to find."""

import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest


@pytest.fixture
def port() -> int:
    """A UDP port of loopback that was free a moment ago."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        free: int = probe.getsockname()[1]
    return free


@pytest.fixture
def rover(port: int) -> Iterator[subprocess.Popen[bytes]]:
    """Calls at `port`, as robots call their ground station."""
    script = Path(__file__).parent / "rover.py"
    with subprocess.Popen([sys.executable, script, f"udpout://127.0.0.1:{port}"]) as process:
        yield process
        assert process.poll() is None, "the rover died"
        process.kill()
