"""Serial ports and ptys, on systems that have such terminals; everything else does without."""

import os
from pathlib import Path

from laglab_protocol.endpoints.interface import Endpoint
from laglab_protocol.errors import NoSuchPortError


def require_terminals(name: str) -> None:
    """Raises NoSuchPortError where the system has no terminals as POSIX knows them."""
    try:
        from laglab_protocol.endpoints import tty  # noqa: F401
    except ImportError as error:
        raise NoSuchPortError(
            f"{name}: this system has no serial ports and ptys as POSIX knows them (no module "
            f"{error.name}): take udpin:// or udpout://, or Linux or macOS"
        ) from None


def open_port(name: str, device: str, baud: int) -> Endpoint:
    """A serial port. Raises NoSuchPortError, PortBusyError."""
    require_terminals(name)
    from laglab_protocol.endpoints.tty import SerialPort

    return SerialPort(device, baud)


def spelled_one_way(path: str | Path) -> Path:
    """The path of a link, the same whichever way leads into its folder."""
    return Path(os.path.realpath(Path(path).parent), Path(path).name)


def make_pty(path: str) -> Endpoint:
    """A pty whose far end is at `path`. Raises NoSuchPortError, PortBusyError."""
    require_terminals(f"pty://{path}")
    from laglab_protocol.endpoints.tty import Pty

    return Pty(path)
