"""Which keys there are, and what is said of each: read from the tables' own fields."""

from collections.abc import Iterator
from typing import Any, NamedTuple, get_args, get_origin

from pydantic.fields import FieldInfo

from laglab.scenario.model import Scenario

ANY = "N"
"""Stands for the number of an element in the place of a key of a list's tables."""


class Key(NamedTuple):
    """One key of a table."""

    name: str
    attribute: str
    """Its value's in Python."""
    unit: str
    sentence: str
    default: object
    table: type | None
    """What stands there, if that is a table or a list of them; it may be left out."""
    many: bool
    """Whether it is a list of tables."""


def keys(table: type) -> list[Key]:
    """The keys of one table, in order."""
    fields: dict[str, FieldInfo] = table.__pydantic_fields__  # type: ignore[attr-defined]
    return [_key(attribute, info) for attribute, info in fields.items()]


def _key(attribute: str, info: FieldInfo) -> Key:
    extra: Any = info.json_schema_extra
    table = _table_in(info.annotation)
    return Key(
        info.alias or attribute,
        attribute,
        extra["unit"],
        info.description or "",
        info.default,
        table,
        table is not None and get_origin(info.annotation) is tuple,
    )


def _table_in(hint: object) -> type | None:
    if isinstance(hint, type) and hasattr(hint, "__pydantic_fields__"):
        return hint
    return next((found for part in get_args(hint) if (found := _table_in(part))), None)


def places(table: type = Scenario, above: str = "") -> Iterator[tuple[str, Key]]:
    """Every key by its dotted place, those of all tables too."""
    for key in keys(table):
        place = above + key.name
        yield place, key
        if key.table is not None:
            yield from places(key.table, f"{place}.{ANY}." if key.many else f"{place}.")
