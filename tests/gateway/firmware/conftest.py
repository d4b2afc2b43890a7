"""The robot in C at the far end of a pty."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from laglab_protocol import STATION_COMPONENT, STATION_SYSTEM, Receiver, Sender, open_endpoint

from .line import SPEED, Line


@pytest.fixture
def line(start: Callable[..., Any], firmware: Path, tmp_path: Path) -> Iterator[Line]:
    """To a robot that runs faster than the clock; it ends with the line, and says so."""
    with open_endpoint(f"pty://{tmp_path}/port") as endpoint:
        robot = start(firmware, "--speed", SPEED, tmp_path / "port")
        yield Line(endpoint, Sender(STATION_SYSTEM, STATION_COMPONENT), Receiver())
    assert robot.wait(5) == 1
    assert "the far end is gone" in robot.stderr.read()
