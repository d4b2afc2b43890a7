"""What mavgen lets through and somebody's generated code then does not bear.

Only the file itself is judged; the dialects that it includes are read for the names and numbers
that they have taken. Nothing in the file is evaluated (mavgen evaluates enum values).
"""

import keyword
import re
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element

from laglab_protocol.dialect.generated import laglab as generated
from laglab_protocol.dialect.includes import carried_dialects, includes_of, parsed

__all__ = [
    "Finding",
    "lint",
]

PRIVATE_IDS = range(52100, 60000)
"""No published dialect uses these."""
LARGEST_PAYLOAD = 255
MOST_FIELDS = 64
SIZES = {
    "char": 1,
    "int8_t": 1,
    "uint8_t": 1,
    "uint8_t_mavlink_version": 1,
    "int16_t": 2,
    "uint16_t": 2,
    "int32_t": 4,
    "uint32_t": 4,
    "float": 4,
    "int64_t": 8,
    "uint64_t": 8,
    "double": 8,
}
TAKEN_FIELD_NAMES = {*keyword.kwlist, *dir(generated.MAVLink_message), "self", "force_mavlink1"}
"""Reserved words of Python, and what a generated Python message already has."""
C_KEYWORD = re.compile(
    "auto|break|case|char|const|continue|default|do|double|else|enum|extern|float|for|goto|if|"
    "inline|int|long|register|restrict|return|short|signed|sizeof|static|struct|switch|typedef|"
    "union|unsigned|void|volatile|while"
)

_UPPER = re.compile(r"[A-Z][A-Z0-9_]*")
_LOWER = re.compile(r"[a-z][a-z0-9_]*")
_TYPE = re.compile(r"(\w+)(?:\[(\d{1,3})\])?")
_NUMBER = re.compile(r"0|[1-9]\d{0,9}|0x[0-9a-fA-F]{1,8}")


class Finding(NamedTuple):
    """Where something is wrong, such as "LAGLAB_TICK.tick", and what."""

    where: str
    what: str


class Names(NamedTuple):
    """What the included dialects have taken."""

    ids: frozenset[int | None]
    messages: frozenset[str]
    enums: frozenset[str]


def lint(xml: Path) -> list[Finding]:
    """All that is wrong with the dialect file, empty when it is fit to generate from.

    Raises DialectError when the file cannot be read, or is no XML.
    """
    root = parsed(xml)
    if root.tag != "mavlink":
        return [Finding(xml.name, f"its root is <{root.tag}>: a dialect's is <mavlink>")]
    taken, missing = _included(xml)
    enums, messages = root.findall("enums/enum"), root.findall("messages/message")
    known_enums = taken.enums | {_name(enum) for enum in enums}
    return [
        *missing,
        *_duplicates("message id", (message.get("id", "") for message in messages)),
        *_duplicates("message name", map(_name, messages)),
        *_duplicates("enum name", map(_name, enums)),
        *_duplicates(
            "entry name", (_name(entry) for enum in enums for entry in enum.iter("entry"))
        ),
        *(found for enum in enums for found in _enum(enum)),
        *(found for message in messages for found in _message(message, taken, known_enums)),
    ]


def _included(xml: Path) -> tuple[Names, list[Finding]]:
    """What the included dialects take; and which are nowhere."""
    includes = includes_of(xml)
    others = [parsed(path) for path in includes.found.values()]
    ids = frozenset(_number(each.get("id")) for other in others for each in other.iter("message"))
    messages = frozenset(_name(each) for other in others for each in other.iter("message"))
    enums = frozenset(_name(each) for other in others for each in other.iter("enum"))
    missing = [
        Finding(xml.name, f"includes {name!r}, which is nowhere") for name in includes.missing
    ]
    return Names(ids, messages, enums), missing


def _duplicates(what: str, values: Iterable[str]) -> Iterator[Finding]:
    for value, count in Counter(values).items():
        if count > 1:
            yield Finding(value, f"{what} used {count} times")


def _number(text: str | None) -> int | None:
    return int(text, 0) if text and _NUMBER.fullmatch(text) else None


def _name(element: Element) -> str:
    return element.get("name", "")


def _described(element: Element) -> bool:
    return bool((element.findtext("description") or "").strip())


def _enum(enum: Element) -> Iterator[Finding]:
    where = _name(enum)
    if not _UPPER.fullmatch(where):
        yield Finding(where, "enum name: use upper-case letters, digits and _")
    if not _described(enum):
        yield Finding(where, "no description")
    entries = enum.findall("entry")
    yield from _duplicates(f"value in {where}", (entry.get("value", "") for entry in entries))
    for entry in entries:
        yield from _entry(entry, f"{where}.{_name(entry)}", where)


def _entry(entry: Element, where: str, enum: str) -> Iterator[Finding]:
    if not _UPPER.fullmatch(_name(entry)):
        yield Finding(where, "entry name: use upper-case letters, digits and _")
    if not _name(entry).startswith(f"{enum}_"):
        yield Finding(where, f"entry name: begin it with {enum}_, for C has one namespace")
    if _number(entry.get("value")) is None:
        yield Finding(where, f"value {entry.get('value')!r}: write a plain number")
    if not _described(entry):
        yield Finding(where, "no description")


def _message(message: Element, taken: Names, enums: frozenset[str]) -> Iterator[Finding]:
    where = _name(message)
    yield from _identity(message, where, taken)
    fields = message.findall("field")
    yield from _duplicates(f"field name in {where}", map(_name, fields))
    yield from _targets(fields, where)
    if not 1 <= len(fields) <= MOST_FIELDS:
        yield Finding(where, f"{len(fields)} fields: have 1 to {MOST_FIELDS}")
    for field in fields:
        yield from _field(field, f"{where}.{_name(field)}", enums)
    size = sum(_size(field) or 0 for field in fields)
    if size > LARGEST_PAYLOAD:
        yield Finding(where, f"payload of {size} bytes: at most {LARGEST_PAYLOAD} fit into a frame")


def _identity(message: Element, where: str, taken: Names) -> Iterator[Finding]:
    if not _UPPER.fullmatch(where):
        yield Finding(where, "message name: use upper-case letters, digits and _")
    if where in taken.messages:
        yield Finding(where, "message name: an included dialect has it already")
    if not _described(message):
        yield Finding(where, "no description")
    number = _number(message.get("id"))
    if number is None:
        yield Finding(where, f"id {message.get('id')!r}: write a plain number")
    elif number in taken.ids:
        yield Finding(where, f"id {number}: an included dialect has it already")
    elif number not in PRIVATE_IDS and not _is_published(message):
        first, last = PRIVATE_IDS[0], PRIVATE_IDS[-1]
        yield Finding(where, f"id {number}: private dialects use {first} to {last}")


def _is_published(message: Element) -> bool:
    """Whether a dialect that pymavlink carries has the very same message."""
    xpath = f"messages/message[@id='{_number(message.get('id'))}']"
    dialects = map(parsed, sorted(carried_dialects().glob("*.xml")))
    return any(_shape(message) == _shape(each) for xml in dialects for each in xml.findall(xpath))


def _shape(message: Element) -> tuple[str, list[tuple[str | None, str]]]:
    """What its checksum is made of, and more: its name, and the types and names of its fields."""
    fields = message.findall("field")
    return _name(message), [(field.get("type"), _name(field)) for field in fields]


def _targets(fields: list[Element], where: str) -> Iterator[Finding]:
    types = {_name(field): field.get("type") for field in fields}
    if "target_component" in types and "target_system" not in types:
        yield Finding(where, "target_component without target_system")
    for name in ("target_system", "target_component"):
        if types.get(name, "uint8_t") != "uint8_t":
            yield Finding(f"{where}.{name}", "type: routers expect uint8_t")


def _field(field: Element, where: str, enums: frozenset[str]) -> Iterator[Finding]:
    name, enum = _name(field), field.get("enum")
    if not _LOWER.fullmatch(name):
        yield Finding(where, "field name: use lower-case letters, digits and _")
    if name in TAKEN_FIELD_NAMES or C_KEYWORD.fullmatch(name):
        yield Finding(where, "field name: collides with a word of C or of the generated Python")
    if _size(field) is None:
        yield Finding(where, f"type {field.get('type')!r}: no type of MAVLink")
    if (field.get("type") or "").startswith(("float", "double")) and field.get("units") is None:
        yield Finding(where, 'no units: write units="" if it has none')
    if not "".join(field.itertext()).strip():
        yield Finding(where, "no description")
    if enum is not None and enum not in enums:
        yield Finding(where, f"enum {enum!r}: defined nowhere")


def _size(field: Element) -> int | None:
    """The bytes of the field on the wire, None when its type is none of MAVLink's."""
    match = _TYPE.fullmatch(field.get("type", ""))
    if match is None or match[1] not in SIZES or match[2] == "0":
        return None
    return SIZES[match[1]] * int(match[2] or 1)
