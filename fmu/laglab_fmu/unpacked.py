"""Where an FMU is unpacked: in a folder whose name tells which process it belongs to."""

import os
import secrets
import shutil
import tempfile
from pathlib import Path


def own_folder() -> Path:
    """For one FMU of this process; not made yet."""
    return Path(tempfile.gettempdir(), f"{_prefix()}{secrets.token_hex(8)}")


def clear_unpacked() -> None:
    """Delete what this process has unpacked: it ends at once, in the midst of an FMU's call."""
    for folder in Path(tempfile.gettempdir()).glob(f"{_prefix()}*"):
        shutil.rmtree(folder, ignore_errors=True)


def _prefix() -> str:
    return f"laglab-fmu-{os.getpid()}-"
