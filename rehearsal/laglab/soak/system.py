"""What Linux tells of processes: their memory, their descriptors, who belongs to whom."""

import re
import signal
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from laglab.errors import UnsupportedSystemError

PROCESSES = Path("/proc")
_STATUS = re.compile(r"^(VmHWM|RssAnon|SigCgt):\s+(\w+)", re.MULTILINE)


class Look(NamedTuple):
    """A process, looked at."""

    memory: int
    """[bytes] Its own: what it shares with files, the system takes and gives as it likes."""
    most_memory: int
    """[bytes] Since its start, files included."""
    descriptors: int
    obeys: bool
    """Whether it handles SIGTERM by now."""


def require_processes() -> None:
    """Raises UnsupportedSystemError where processes cannot be looked at."""
    if not (PROCESSES / "self" / "fd").exists():
        raise UnsupportedSystemError(
            f"a soak looks into {PROCESSES}, which this system does not have: take Linux"
        )


def look(process: int) -> Look | None:
    """What the process takes; None: it has ended."""
    folder = PROCESSES / str(process)
    try:
        told = dict(_STATUS.findall((folder / "status").read_text()))
        descriptors = len(list((folder / "fd").iterdir()))
    except OSError:
        return None
    if "RssAnon" not in told:
        return None  # it has ended, and nobody has asked how
    caught = int(told["SigCgt"], 16) >> (signal.SIGTERM - 1) & 1
    return Look(1024 * int(told["RssAnon"]), 1024 * int(told["VmHWM"]), descriptors, bool(caught))


def marked(mark: str) -> list[int]:
    """The processes that have this text in their environment, which children inherit."""
    found = []
    for folder in PROCESSES.glob("[0-9]*"):
        with suppress(OSError):  # it has just ended, or is somebody else's
            if mark.encode() in (folder / "environ").read_bytes():
                found.append(int(folder.name))
    return found
