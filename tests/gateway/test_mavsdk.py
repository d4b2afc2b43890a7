"""mavsdk finds the robot, reads and sets parameters, arms it, sees it move."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.slow
@pytest.mark.usefixtures("rover")
def test_mavsdk_finds_reads_sets_arms_and_sees_it_move(port: int, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, Path(__file__).parent / "mavsdk_client.py", str(port)],
        env=os.environ | {"TMPDIR": str(tmp_path)},  # it leaves a folder there
        capture_output=True,
        text=True,
        check=False,
        timeout=50,
    )
    assert done.returncode == 0, done.stderr
    seen = json.loads(done.stdout.splitlines()[-1])

    assert seen["system"] == 1
    assert seen["read"] == 0.0
    assert seen["set"] == 1.25
    assert seen["refused"] == "READ_ONLY"
    assert (seen["before"]["x"], seen["before"]["y"]) == (-2.0, -3.0)
    assert seen["armed"] == 0
    assert seen["after"]["x"] != -2.0
    assert seen["reset while armed"] == 1
