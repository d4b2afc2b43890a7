"""pymavlink's own receiver, as its mavutil uses it: one parser for all datagrams."""

from laglab_protocol.dialect.generated import laglab as dialect


def frames_of_pymavlink(datagrams: list[bytes]) -> list[bytes]:
    """Those that it checked: it also gives bad data, and unknown messages with any CRC."""
    parser = dialect.MAVLink(None)
    parser.robust_parsing = True
    read = [each for datagram in datagrams for each in parser.parse_buffer(datagram) or []]
    known = [each for each in read if not each.get_type().startswith(("BAD_DATA", "UNKNOWN_"))]
    return [bytes(each.get_msgbuf()) for each in known]
