"""Where an FMU is unpacked: in a folder whose name tells which process it belongs to."""

import os
import secrets
import shutil
import tempfile
from pathlib import Path

from laglab_fmu.errors import CallError


def own_folder() -> Path:
    """For one FMU of this process; not made yet.

    Raises CallError: FMPy goes to a library's folder and could not come back.
    """
    try:
        Path.cwd()
    except OSError as error:
        raise CallError("the current directory is gone: go to one that is there") from error
    return Path(tempfile.gettempdir(), f"{_prefix()}{secrets.token_hex(8)}")


def clear_unpacked() -> None:
    """Delete what this process has unpacked: it ends at once, in the midst of an FMU's call."""
    for folder in Path(tempfile.gettempdir()).glob(f"{_prefix()}*"):
        shutil.rmtree(folder, ignore_errors=True)


def _prefix() -> str:
    return f"laglab-fmu-{os.getpid()}-"
