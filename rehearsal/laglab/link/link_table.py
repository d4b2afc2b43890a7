"""A `[link]` table: a scenario file, or the end of one."""

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import NamedTuple

import tomlkit
from tomlkit.items import InlineTable, Item, Table

from laglab_gateway import IDEAL, Impairments

DIGITS = 6
"""Significant ones, of a number."""


class Bounds(NamedTuple):
    """How late messages are played out [ticks]: commands, measurements."""

    command: int
    measurement: int


class FittedLink(NamedTuple):
    """A link as a scenario has it."""

    command_delay: int
    measurement_delay: int
    command: Impairments = IDEAL
    measurement: Impairments = IDEAL
    playout: Bounds | None = None


def link_table(link: FittedLink) -> Table:
    """Its `[link]`: what is not the default."""
    table = tomlkit.table()
    table["command_delay"] = link.command_delay
    table["measurement_delay"] = link.measurement_delay
    if link.playout is not None:
        table["playout"] = _inline(link.playout._asdict())
    for name in ("command", "measurement"):
        if (impairments := getattr(link, name)) != IDEAL:
            table[name] = _table(impairments)
    return table


def link_toml(link: FittedLink) -> str:
    """The same as a file."""
    document = tomlkit.document()
    document["link"] = link_table(link)
    return tomlkit.dumps(document)


def _table(impairments: Impairments) -> Table:
    table = tomlkit.table()
    for name, value in _set(impairments).items():
        table[name] = value
    return table


def _set(made: object) -> dict[str, Item]:
    """The fields of a value that are not as they are by default."""
    assert is_dataclass(made)
    assert not isinstance(made, type)
    default = _by_default(type(made))
    values = {field.name: getattr(made, field.name) for field in fields(made)}
    return {name: _item(value) for name, value in values.items() if value != default[name]}


def _by_default(kind: type) -> dict[str, object]:
    """The values of a class whose fields all have one."""
    return {field.name: field.default for field in fields(kind)}


def _item(value: object) -> Item:
    if is_dataclass(value):
        return _inline(_set(value))
    if isinstance(value, tuple):
        return tomlkit.item([_rounded(each) for each in value])
    return tomlkit.item(_rounded(value))


def _rounded(value: object) -> object:
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value


def _inline(items: Mapping[str, object]) -> InlineTable:
    table = tomlkit.inline_table()
    table.update(items)
    return table
