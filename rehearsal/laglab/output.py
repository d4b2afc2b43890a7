"""Standard output and error, whatever they are: another encoding, a closed pipe, a full disk."""

import contextlib
import io
import os
import sys
from collections.abc import Callable
from typing import TextIO

READER_GONE = 141
"""Whoever read our output has gone away: as a shell says it of SIGPIPE."""
CANNOT_WRITE = 4


def prepare() -> None:
    """From now on a character that the output's encoding lacks becomes a question mark."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


def guarded(work: Callable[[], int]) -> int:
    """The work's exit code; or that of its output, when that cannot be written."""
    try:
        code = work()
        sys.stdout.flush()
    except BrokenPipeError:
        _give_up(sys.stdout)
        return READER_GONE
    except OSError as error:
        _give_up(sys.stdout)
        with contextlib.suppress(OSError):
            print(f"laglab: cannot write the output: {error.strerror}", file=sys.stderr)
        return CANNOT_WRITE
    return code


def _give_up(stream: TextIO) -> None:
    """What is still in the stream's buffer must not fail again when Python ends."""
    with contextlib.suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
