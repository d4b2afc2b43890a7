"""The firmware in C."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

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
