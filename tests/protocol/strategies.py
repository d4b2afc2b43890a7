"""Messages for hypothesis, every field over the whole range of its type."""

import struct
from functools import cache
from typing import Any

from hypothesis import strategies as st

from laglab_protocol import Message, message_type
from laglab_protocol.dialect.generated import laglab as dialect
from laglab_protocol.messages.names import WRITTEN_OUT

FLOATS = {
    "f": st.floats(width=32, allow_nan=False),
    "d": st.floats(allow_nan=False),
}


def _scalar(code: str) -> st.SearchStrategy[Any]:
    if code in FLOATS:
        return FLOATS[code]
    bits = 8 * struct.calcsize("<" + code)
    low = -(1 << bits - 1) if code.islower() else 0
    return st.integers(low, low + (1 << bits) - 1)


@cache
def messages_named(name: str) -> st.SearchStrategy[Message]:
    kind = message_type(name)
    generated = next(each for each in dialect.mavlink_map.values() if each.msgname == name)
    codes = generated.native_format.decode().lstrip("<")
    fields: list[st.SearchStrategy[Any]] = []
    for code, length in zip(codes, generated.array_lengths, strict=True):
        if code == "c":
            fields.append(st.binary(max_size=length).map(lambda text: text.rstrip(b"\0")))
        elif length > 1:
            fields.append(st.tuples(*[_scalar(code)] * length))
        else:
            fields.append(_scalar(code))
    return st.tuples(*fields).map(lambda values: kind(*values))


OURS = [name for name in WRITTEN_OUT if name.startswith("LAGLAB_")]
STANDARD = ["HEARTBEAT", "PARAM_VALUE", "STATUSTEXT", "ODOMETRY", "COMMAND_ACK", "BATTERY_STATUS"]


@cache
def messages() -> st.SearchStrategy[Message]:
    return st.sampled_from(OURS + STANDARD).flatmap(messages_named)
