"""What every message is."""

from msgspec import Struct


class Message(Struct, frozen=True, gc=False):
    """A record that cannot be changed, its fields in the order in which they travel.

    Integer fields take ints, float and double fields floats, text fields bytes (without the zero
    bytes that pad them), arrays tuples. In the classes that are written out, fields that a message
    gained later (MAVLink 2 extensions) default to 0, as a receiver reads them.
    `msgspec.structs` has `astuple`, `asdict`, `replace`.
    """
