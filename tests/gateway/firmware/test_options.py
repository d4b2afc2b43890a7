"""The firmware's own command line."""

import subprocess
from pathlib import Path

import pytest


@pytest.mark.parametrize(
    "told",
    [
        ("--playout", "x"),
        ("--playout", "1.5"),
        ("--playout", "-3"),
        ("--playout", "99999999999"),
        ("--speed", "4x"),
        ("--speed", "nan"),
        ("--speed", ""),
    ],
)
def test_what_is_no_number_in_range_is_refused(firmware: Path, told: tuple[str, str]) -> None:
    done = subprocess.run(
        [firmware, *told, "port"], capture_output=True, text=True, check=False, timeout=10
    )
    assert done.returncode == 2
    assert done.stderr.startswith("usage: ")
