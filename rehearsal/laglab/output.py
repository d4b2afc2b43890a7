"""Standard output and error, whatever they are: another encoding, closed, full, nobody reads."""

import codecs
import errno
import io
import os
import sys
import unicodedata
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

READER_GONE = 141
"""Whoever read our output has gone away: as a shell says it of SIGPIPE."""
CANNOT_WRITE = 4
PLAIN = {"×": "x", "·": "*", "−": "-", "µ": "u", "μ": "u", "…": "...", "⋆": "*"}
SPELLED_OUT = "laglab-spelled-out"


def guarded(work: Callable[[], int]) -> int:
    """The work's exit code; where that is 0, the one that tells of output which was not written.

    The work goes on to its end when nobody reads what it says.
    """
    _open_what_is_closed()
    codecs.register_error(SPELLED_OUT, _spelled_out)
    with _lasting("stdout") as output, _lasting("stderr") as errors:
        code = work()
    failure = output.failure or errors.failure
    if code or failure is None:
        return code
    if isinstance(failure, BrokenPipeError):
        return READER_GONE
    with _lasting("stderr"):
        print(f"laglab: cannot write the output: {failure.strerror}", file=sys.stderr)
    return CANNOT_WRITE


def _open_what_is_closed() -> None:
    """A descriptor that is closed would go to the next file opened, and get what we print."""
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: PTH123, SIM115


class _Lasting(io.RawIOBase):
    """Keeps the first failure to write; what is written from then on is dropped."""

    def __init__(self, raw: io.RawIOBase | None) -> None:
        self._raw = raw
        self.failure: OSError | None = None

    def write(self, data: "ReadableBuffer") -> int | None:
        if self._raw and not self.failure:
            try:
                return self._raw.write(data)
            except OSError as error:
                self.failure = error
            except ValueError:  # somebody has closed it
                self.failure = OSError(errno.EBADF, os.strerror(errno.EBADF))
        return memoryview(data).nbytes

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._raw.fileno() if self._raw else super().fileno()

    def isatty(self) -> bool:
        return self._raw is not None and self._raw.isatty()


class _Buffer(io.BufferedWriter):
    def close(self) -> None:
        self.flush()

    def detach(self) -> Any:
        self.flush()
        return self.raw


class _Text(io.TextIOWrapper):
    """Code that somebody brought may close it, or take its buffer: it stays open to us."""

    def close(self) -> None:
        self.flush()

    def detach(self) -> Any:
        self.flush()
        return self.buffer


@contextmanager
def _lasting(name: str) -> Iterator[_Lasting]:
    """sys.stdout or sys.stderr, if it is one of the system's, made to last for a while."""
    stream = getattr(sys, name)
    buffer = getattr(stream, "buffer", None)
    raw = getattr(buffer, "raw", buffer)
    if not isinstance(stream, io.TextIOWrapper) or not isinstance(raw, io.RawIOBase):
        yield _Lasting(None)
        return
    stream.flush()
    lasting = _Lasting(raw)
    wrapped = _Text(
        _Buffer(lasting),
        stream.encoding,
        errors=SPELLED_OUT,
        line_buffering=stream.line_buffering,
        write_through=stream.write_through,
    )
    setattr(sys, name, wrapped)
    try:
        yield lasting
    finally:
        wrapped.flush()
        setattr(sys, name, stream)


def _spelled_out(error: UnicodeError) -> tuple[str, int]:
    """For what the encoding of the output does not have."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(map(_plain, error.object[error.start : error.end])), error.end


def _plain(character: str) -> str:
    name = unicodedata.name(character, "")
    if character in PLAIN or unicodedata.combining(character):
        return PLAIN.get(character, "")
    return name.split()[-1].lower() if name.startswith("GREEK") else "?"
