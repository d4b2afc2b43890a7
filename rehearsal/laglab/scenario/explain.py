"""A scenario told key by key: value, unit, default, and what each is for."""

import textwrap

import tomlkit

from laglab.scenario.keys import Row, rows
from laglab.scenario.model import Scenario, plain

WIDTH = 79
"""Columns."""
INDENT = " " * 4
NOT_SET = "not set"


def explained(scenario: Scenario) -> str:
    """Every key on a line of its own, dotted as `--set` takes it; what is said of it below."""
    return "\n".join(_table(row) if row.key.table else _value(row) for row in rows(scenario))


def spelled(value: object) -> str:
    """As in a file; None is a key that is not set."""
    if value is None:
        return NOT_SET
    within = tomlkit.item([[plain(value)]])  # where tables stand in a line
    return str(within.as_string())[2:-2]


def _table(row: Row) -> str:
    nothing = "" if row.value else f", {NOT_SET}"
    return f"\n[{row.place}]{nothing}\n{_indented(row.key.sentence)}"


def _value(row: Row) -> str:
    value = textwrap.fill(f"{row.place} = {spelled(row.value)}", WIDTH, subsequent_indent=INDENT)
    unit, sentence, default = row.key.unit, row.key.sentence, spelled(row.key.default)
    return f"{value}\n{_indented(f'[{unit}] {sentence} Default: {default}.')}"


def _indented(text: str) -> str:
    return textwrap.fill(
        text,
        WIDTH,
        initial_indent=INDENT,
        subsequent_indent=INDENT,
        break_on_hyphens=False,
    )
