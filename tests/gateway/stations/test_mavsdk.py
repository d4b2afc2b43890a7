"""mavsdk, 3 and 4, finds the robot, looks around without a time-out, arms it, sees it move."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from .asked import Asked

HERE = Path(__file__).parent
SECONDS = 7.0
"""mavsdk's own time-outs for one request are half a second and three tries, and more for lists."""


def told(python: Path | str, client: str, port: int, folder: Path) -> Any:
    done = subprocess.run(
        [python, "-W", "ignore", HERE / client, str(port)],
        env=os.environ | {"TMPDIR": str(folder)},  # it leaves a folder there
        capture_output=True,
        text=True,
        check=False,
        timeout=50,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


AROUND = {
    "odometry": [-2.0, -3.0],
    "position": [pytest.approx(21.038, abs=1e-4), pytest.approx(105.782, abs=1e-4)],
    "home": [21.038, 105.782],
    "landed": "ON_GROUND",
    "health": True,
    "origin": 21.038,
    "version": 1,
    **dict.fromkeys(("mission", "fence", "rally"), "[]"),
    "logs": "NO_LOGFILES",
    "files": "UNSUPPORTED",
    "hold": "COMMAND_DENIED",
}


@pytest.mark.slow
def test_mavsdk_4_looks_around_arms_and_sees_it_move(
    port: int, rover: Asked, tmp_path: Path
) -> None:
    seen = told(sys.executable, "mavsdk4_client.py", port, tmp_path)

    assert seen["system"] == 1
    assert seen["read"] == 0.0
    assert seen["set"] == 1.5
    assert seen["refused"] == "READ_ONLY"
    assert seen["around"].pop("frames") == ["BODY_NED", "BODY_NED"]
    assert seen["around"].pop("cleared") != "TIMEOUT"
    assert seen["around"] == AROUND
    assert seen["seconds"] < SECONDS
    assert (seen["before"]["x"], seen["before"]["y"]) == (-2.0, -3.0)
    assert seen["armed"] == 0
    assert seen["after"]["x"] != -2.0
    assert seen["reset while armed"] == 1
    rover.check_against_table("mavsdk 4")


@pytest.fixture
def python_with_mavsdk_3(install_afresh: Callable[..., Path]) -> Path:
    """An environment of its own, for mavsdk 3 and 4 bear the same name."""
    try:
        return install_afresh("mavsdk>=3.17,<4")
    except (OSError, subprocess.SubprocessError) as error:
        pytest.skip(f"mavsdk 3 is not to be had here: {error}")


@pytest.mark.slow
@pytest.mark.timeout(200)
def test_mavsdk_3_looks_around_and_arms(
    port: int, python_with_mavsdk_3: Path, rover: Asked, tmp_path: Path
) -> None:
    seen = told(python_with_mavsdk_3, "mavsdk3_client.py", port, tmp_path)

    assert seen["around"].pop("cleared") == "None"
    assert seen["around"] == AROUND
    assert seen["seconds"] < SECONDS
    assert (seen["set"], seen["parameters"]) == (1.5, 5)
    assert (seen["armed"], seen["disarmed"]) == ("None", "None")
    rover.check_against_table("mavsdk 3")
