"""Which keys there are, and what is said of each: read from the tables' own fields."""

from collections.abc import Iterator
from typing import Any, NamedTuple, get_args, get_origin

from pydantic.fields import FieldInfo

from laglab.scenario.model import Scenario

ANY = "N"
"""Stands for the number of an element in the place of a key of a list's tables."""

NO_UNIT = "-"
"""Of what is no number."""


class Key(NamedTuple):
    """One key of a table."""

    name: str
    attribute: str
    """What it is called in Python."""
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
        info.get_default(call_default_factory=True, validated_data={}),
        table,
        table is not None and get_origin(info.annotation) is tuple,
    )


def _table_in(hint: object) -> type | None:
    if isinstance(hint, type) and hasattr(hint, "__pydantic_fields__"):
        return hint
    return next((found for part in get_args(hint) if (found := _table_in(part))), None)


class Row(NamedTuple):
    """A key at its place, and the value there; None: it is not set."""

    place: str
    key: Key
    value: object


def rows(value: object = None, table: type = Scenario, above: str = "") -> Iterator[Row]:
    """Every key of a scenario, or of none, in the order of a file: each table after the values."""
    for key in sorted(keys(table), key=lambda key: key.table is not None):
        place, here = above + key.name, getattr(value, key.attribute, None)
        yield Row(place, key, here)
        if key.table is not None:
            for inside, one in _tables(key, place, here):
                yield from rows(one, key.table, f"{inside}.")


def _tables(key: Key, place: str, here: Any) -> list[tuple[str, object]]:
    """The tables at a place, each with its own; where a list has none, what one would have."""
    if not key.many:
        return [(place, here)]
    return [(f"{place}.{i}", one) for i, one in enumerate(here or ())] or [(f"{place}.{ANY}", None)]
