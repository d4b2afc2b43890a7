"""How endpoints are spelled.

udpin://host:port   udpin:host:port     udpin://:port binds 127.0.0.1
udpout://host:port  udpout:host:port
serial:///dev/ttyUSB0:57600             /dev/ttyUSB0,57600
pty://PATH
"""

from laglab_protocol.endpoints.interface import Endpoint
from laglab_protocol.endpoints.terminals import make_pty, open_port
from laglab_protocol.endpoints.udp import UdpIn, UdpOut
from laglab_protocol.errors import BadUrlError

SPELLINGS = "udpin://host:port, udpout://host:port, serial://DEVICE:baud or pty://PATH"


def open_endpoint(url: str) -> Endpoint:
    """Open the endpoint that `url` spells.

    Raises BadUrlError naming the part that is wrong, NoSuchPortError, PortBusyError.
    """
    scheme, rest = _split_scheme(url)
    match scheme:
        case "udpin":
            return UdpIn(*_host_and_port(url, rest))
        case "udpout":
            return UdpOut(*_host_and_port(url, rest, least=1))  # nobody listens at 0
        case "serial":
            return open_port(url, *_device_and_baud(url, rest, ":"))
        case "device":
            return open_port(url, *_device_and_baud(url, rest, ","))
        case "pty":
            if not rest:
                raise BadUrlError(f"{url!r}: no path: write pty://PATH")
            return make_pty(rest)
    raise BadUrlError(f"{url!r}: unknown kind {scheme!r}: write {SPELLINGS}")


def _split_scheme(url: str) -> tuple[str, str]:
    if url.startswith("/"):
        return "device", url
    scheme, colon, rest = url.partition(":")
    if not colon:
        raise BadUrlError(f"{url!r}: no kind of endpoint before a colon: write {SPELLINGS}")
    return scheme, rest.removeprefix("//")


def _host_and_port(url: str, rest: str, least: int = 0) -> tuple[str, int]:
    host, colon, port = rest.rpartition(":")
    if not colon:
        raise BadUrlError(f"{url!r}: no port: write host:port")
    return host.strip("[]") or "127.0.0.1", _number(url, "port", port, 65535, least)


def _device_and_baud(url: str, rest: str, separator: str) -> tuple[str, int]:
    device, found, baud = rest.rpartition(separator)
    if not found:
        raise BadUrlError(f"{url!r}: no baud: write it after the device, {rest}{separator}115200")
    if not device:
        raise BadUrlError(f"{url!r}: no device: write /dev/… before the baud")
    return device, _number(url, "baud", baud, 4_000_000, least=1)


def _number(url: str, part: str, text: str, most: int, least: int = 0) -> int:
    if not text.isascii() or not text.isdigit() or not least <= int(text) <= most:
        raise BadUrlError(f"{url!r}: {part} {text!r} is no number from {least} to {most}")
    return int(text)
