"""Every message of the dialect, by its name in the XML.

Those that this project handles are written out, so that a type checker knows their fields; the
others are made when they are asked for.
"""

import re
from collections.abc import Iterator

from msgspec import defstruct

from laglab_protocol.dialect.generated import laglab as dialect
from laglab_protocol.errors import DialectError
from laglab_protocol.messages import autopilots, geographic, loop, missions, standard
from laglab_protocol.messages.base import Message


def _written_out() -> Iterator[tuple[str, type[Message]]]:
    """A class is called as its message: CommandLong is COMMAND_LONG, Tick LAGLAB_TICK."""
    for module in (loop, standard, geographic, missions, autopilots):
        for kind in vars(module).values():
            if isinstance(kind, type) and issubclass(kind, Message) and kind is not Message:
                name = re.sub(r"(?<!^)(?=[A-Z])", "_", kind.__name__).upper()
                yield f"LAGLAB_{name}" if module is loop else name, kind


WRITTEN_OUT = dict(_written_out())

_IDS: dict[str, int] = {made.msgname: number for number, made in dialect.mavlink_map.items()}
_types = dict(WRITTEN_OUT)


def message_type(name: str) -> type[Message]:
    """The class of any message, by its name. Raises DialectError when the dialect has none."""
    if name not in _IDS:
        raise DialectError(f"no message {name!r} in the dialect: write it as the XML does")
    if name not in _types:
        generated = dialect.mavlink_map[_IDS[name]]
        made = defstruct(name, generated.ordered_fieldnames, bases=(Message,))
        assert issubclass(made, Message)
        _types[name] = made
    return _types[name]
