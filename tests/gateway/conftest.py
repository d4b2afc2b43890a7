"""Robots in processes of their own: a rover for others to find, and the firmware in C."""

import os
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


FIRMWARE = Path(__file__).parents[2] / "examples" / "firmware"


@pytest.fixture(scope="session")
def firmware(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example's program, built as its README says, and watched for undefined behaviour."""
    folder = tmp_path_factory.mktemp("firmware")
    subprocess.run(
        [sys.executable, FIRMWARE / "build.py", folder],
        env=os.environ | {"CFLAGS": "-fsanitize=undefined -fno-sanitize-recover"},
        check=True,
        timeout=50,
    )
    return folder / "firmware"
