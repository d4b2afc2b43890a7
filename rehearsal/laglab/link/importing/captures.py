"""Datagrams in a capture, by dpkt."""

from collections.abc import Iterator
from pathlib import Path

import dpkt

from laglab.link.errors import LinkFileError

LINKS = {
    dpkt.pcap.DLT_EN10MB: dpkt.ethernet.Ethernet,
    dpkt.pcap.DLT_LINUX_SLL: dpkt.sll.SLL,
    dpkt.pcap.DLT_LINUX_SLL2: dpkt.sll2.SLL2,
    dpkt.pcap.DLT_NULL: dpkt.loopback.Loopback,
    dpkt.pcap.DLT_RAW: dpkt.ip.IP,
    101: dpkt.ip.IP,  # LINKTYPE_RAW, as files have it
}
"""What a captured packet begins with, by the capture's kind."""


def datagrams(path: Path) -> Iterator[tuple[float, bytes]]:
    """The payloads of its UDP datagrams and their times [s]. Raises LinkFileError."""
    try:
        with path.open("rb") as file:
            reader = dpkt.pcap.UniversalReader(file)
            link = LINKS.get(reader.datalink())
            if link is None:
                raise LinkFileError(f"{path}: captured on a link of an unknown kind")
            for time, packet in reader:
                if (payload := _payload(link, packet)) is not None:
                    yield float(time), payload
    except OSError as error:
        raise LinkFileError(f"{path} cannot be read: {error.strerror}") from error
    except (dpkt.Error, ValueError) as error:
        raise LinkFileError(f"{path}: not a readable capture: {error}") from error


def _payload(link: type[dpkt.Packet], packet: bytes) -> bytes | None:
    try:
        inside = link(packet)
    except dpkt.Error:
        return None  # cut short, or of another kind
    while isinstance(inside, dpkt.Packet) and not isinstance(inside, dpkt.udp.UDP):
        inside = inside.data
    return bytes(inside.data) if isinstance(inside, dpkt.udp.UDP) else None
