"""pymavlink's own receiver, as its mavutil uses it: one parser for all datagrams."""

from laglab_protocol.dialect.generated import laglab as dialect


def frames_of_pymavlink(datagrams: list[bytes]) -> list[bytes]:
    parser = dialect.MAVLink(None)
    parser.robust_parsing = True
    read = [each for datagram in datagrams for each in parser.parse_buffer(datagram) or []]
    return [bytes(each.get_msgbuf()) for each in read if each.get_type() != "BAD_DATA"]
