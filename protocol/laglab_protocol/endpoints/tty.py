"""Real serial ports, and pseudo-terminals that look like one to any other program."""

import contextlib
import errno
import hashlib
import os
import re
import select
import socket
import stat
import sys
import tty
from pathlib import Path
from time import monotonic

import serial

from laglab_protocol.endpoints.interface import Address, Endpoint
from laglab_protocol.endpoints.terminals import spelled_one_way
from laglab_protocol.endpoints.waiting import first_bytes, writable
from laglab_protocol.errors import (
    FarEndGoneError,
    FarEndStalledError,
    NoSuchPortError,
    PortBusyError,
)

READ_AT_MOST = 1024
"""Bytes at a time: whoever reads looks at its clock in between."""
NOWHERE = -1
"""The descriptor of a port that is closed: its number goes to the next file that is opened."""
PSEUDO = re.compile(r"/dev/(pts/|ttys)\d+")
"""The names of pseudo-terminals, on Linux and on macOS."""
STALL_TIMEOUT = 1.0
"""Seconds that a full queue may stay full before the far end counts as stalled."""


class _Tty(Endpoint):
    """Reads and writes a descriptor that does not block."""

    datagrams = False
    loopback = True

    def __init__(self, name: str, descriptor: int) -> None:
        self.name = name
        self._hold(descriptor)

    def _hold(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self._begun = b""
        """The rest of what there was room for the beginning of only: it goes first."""
        self._full_since: float | None = None
        self._line = select.poll()
        self._line.register(descriptor, select.POLLHUP)
        os.set_blocking(descriptor, False)

    def fileno(self) -> int:
        return self._descriptor

    def receive(self, timeout: float) -> bytes:
        return first_bytes(self._read, self.fileno, timeout)

    def _read(self) -> bytes | None:
        try:
            data = os.read(self._descriptor, READ_AT_MOST)
        except BlockingIOError:
            return None
        except OSError as error:
            raise self._gone(error.strerror) from error
        if not data and self._line.poll(0):
            raise self._gone("hung up")
        return data or None  # where VMIN is 0, as pyserial sets it, silence is a read of no bytes

    def send(self, data: bytes, to: Address | None = None) -> None:
        del to  # there is only one far end
        while not self._begin(data):
            if not self._wait():
                return  # nobody reads: as on any wire, it is lost
        while not self._go_on():
            if not self._wait():
                return

    def offer(self, data: bytes, to: Address | None = None) -> None:
        del to
        if not self._begin(data) and self._stalled():
            raise FarEndStalledError(
                f"{self.name}: the far end has stopped reading, {len(data)} bytes cannot be sent: "
                "see whether the program there still runs"
            )

    def _begin(self, data: bytes) -> bool:
        """Whether there was room for at least some of it."""
        if not self._go_on():
            return False
        rest = self._write(data)
        if data and rest == data:
            return False
        self._begun, self._full_since = rest, None
        return True

    def _go_on(self) -> bool:
        """Whether all of what was begun is written."""
        waiting, self._begun = self._begun, self._write(self._begun)
        if len(self._begun) < len(waiting):
            self._full_since = None  # it reads, if slowly
        return not self._begun

    def _wait(self) -> bool:
        """For room; False when there has been none for STALL_TIMEOUT, and then at once."""
        return not self._stalled() and writable(self._descriptor, STALL_TIMEOUT)

    def _stalled(self) -> bool:
        """Of a queue that is full: whether it has been that for STALL_TIMEOUT."""
        now = monotonic()
        if self._full_since is None:
            self._full_since = now
        return now - self._full_since > STALL_TIMEOUT

    def _write(self, data: bytes) -> bytes:
        """Writes what there is room for; returns the rest."""
        try:
            return data[os.write(self._descriptor, data) :] if data else data
        except BlockingIOError:
            return data
        except OSError as error:
            raise self._gone(error.strerror) from error

    def _gone(self, reason: str | None) -> FarEndGoneError:
        return FarEndGoneError(
            f"{self.name}: the far end is gone ({reason}): plug it in again, then start again"
        )


class SerialPort(_Tty):
    """A serial port, or the path of somebody's pty. Held exclusively: two readers share bytes."""

    def __init__(self, device: str, baud: int) -> None:
        self._device, self._baud = device, baud
        self._port = _open_port(device, baud)
        self._plug = _plug(device)
        super().__init__(_spelled(device, baud), self._port.fileno())

    def reopen(self) -> None:
        """A pty counts as plugged in again only where its link was made anew: its number goes to
        the next program that makes one."""
        self._port.close()
        self._descriptor = NOWHERE
        plug = _plug(self._device)
        if plug == self._plug and PSEUDO.fullmatch(os.path.realpath(self._device)):
            raise NoSuchPortError(f"{self.name}: nobody has made {self._device} again")
        self._port = _open_port(self._device, self._baud)
        self._plug = plug
        self._hold(self._port.fileno())

    def close(self) -> None:
        self._port.close()
        self._descriptor = NOWHERE


def _plug(device: str) -> tuple[int, int] | None:
    """Tells one link of that name from the next; None when there is none."""
    try:
        found = os.lstat(device)
    except OSError:
        return None
    return (found.st_ino, found.st_ctime_ns) if stat.S_ISLNK(found.st_mode) else (0, 0)


def _spelled(device: str, baud: int) -> str:
    return f"serial://{device}:{baud}"


def _open_port(device: str, baud: int) -> serial.Serial:
    name = _spelled(device, baud)
    if not Path(device).exists():
        raise NoSuchPortError(f"{name}: no such port {device}: see which ports /dev has")
    try:
        return serial.Serial(device, baud, timeout=0, exclusive=True)
    except (serial.SerialException, OSError, ValueError) as error:
        raise _cannot_open(name, error) from error


class Pty(_Tty):
    """A raw pseudo-terminal of our own, whose far end others open at `path` as a serial port."""

    def __init__(self, path: str) -> None:
        link = Path(path)
        self._link: Path | None = None
        self._claim = _claim(link)
        try:
            _make_way(link)
            self._descriptor, self._slave = os.openpty()
            self._link = link
            # Raw, and one far descriptor kept open here: a cooked pty echoes, a hung-up one fails.
            tty.setraw(self._slave)
            self._device = os.ttyname(self._slave)
            super().__init__(f"pty://{path}", self._descriptor)
            link.symlink_to(self._device)
        except OSError as error:
            self.close()
            raise NoSuchPortError(
                f"pty://{path}: cannot make the link: {error.strerror}: choose another path"
            ) from error
        except BaseException:
            self.close()  # an interrupt may come at any moment
            raise

    def close(self) -> None:
        if self._claim:
            self._claim.close()
        if self._link is None:
            return
        # A later owner may have put its own link there.
        with contextlib.suppress(OSError):
            if self._link.is_symlink() and str(self._link.readlink()) == self._device:
                self._link.unlink()
        self._link = None
        os.close(self._descriptor)
        os.close(self._slave)
        self._descriptor = NOWHERE


def _claim(link: Path) -> socket.socket | None:
    """Of the path, until its program ends, however it does; where the system has no names that go
    with their program, nobody can tell."""
    if sys.platform != "linux":
        return None
    name = hashlib.sha256(os.fsencode(spelled_one_way(link))).hexdigest()[:40]
    claim = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    try:
        claim.bind(f"\0laglab-pty-{name}")
    except OSError as error:
        claim.close()
        raise PortBusyError(
            f"pty://{link}: a program that still runs has made it: end it first, or choose another "
            "path"
        ) from error
    return claim


def _make_way(link: Path) -> None:
    """Remove a link that an earlier run left behind; leave anything else alone."""
    if link.is_symlink() and PSEUDO.fullmatch(str(link.readlink())):
        link.unlink()
    elif link.exists() or link.is_symlink():
        raise PortBusyError(f"pty://{link}: a file is there already: choose another path")


def _cannot_open(name: str, error: Exception) -> NoSuchPortError | PortBusyError:
    if "exclusively lock" in str(error):
        return PortBusyError(f"{name}: another program holds the port: end it first")
    if getattr(error, "errno", None) == errno.EACCES:
        return NoSuchPortError(f"{name}: not permitted: join the group that owns the port")
    return NoSuchPortError(f"{name}: cannot open it as a serial port: {error}: check port and baud")
