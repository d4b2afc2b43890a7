"""The table of docs/ground-stations.md: what is asked, what is answered, who asks so.

A message is written as its name and some of its fields: `COMMAND_ACK result=MAV_RESULT_DENIED`.
Numbers may stand as names of the dialect, messages' ids as the messages' names.
"""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from laglab_protocol.dialect.generated import laglab as dialect

PAGE = Path(__file__).parents[3] / "docs" / "ground-stations.md"

Field = float | str | list[float]


class Said(NamedTuple):
    """A message, and those of its fields that matter; `payload[3]` is an element of a field."""

    name: str
    fields: dict[str, float | str]

    def is_like(self, name: str, fields: Mapping[str, Field]) -> bool:
        """Whether the message has this name and these fields, among others."""
        return name == self.name and all(
            value_of(fields, field) == value for field, value in self.fields.items()
        )


class Row(NamedTuple):
    """What is answered; `many` when the one answer comes as often as there is something to tell."""

    request: Said
    answers: list[Said]
    many: bool
    clients: set[str]

    def __str__(self) -> str:
        return " ".join([self.request.name, *map(str, self.request.fields.values())])


def value_of(fields: Mapping[str, Field], field: str) -> Field | None:
    name, *index = re.findall(r"\w+", field)
    value = fields.get(name)
    return value[int(index[0])] if index and isinstance(value, list) else value


def _value(text: str) -> float | str:
    for name in (text, f"MAVLINK_MSG_ID_{text}"):
        if isinstance(found := getattr(dialect, name, None), int):
            return found
    try:
        return float(text)
    except ValueError:
        return text


def _said(text: str) -> Said:
    name, *fields = text.split()
    pairs = (field.split("=") for field in fields)
    return Said(name, {field: _value(value) for field, value in pairs})


def _row(line: str) -> Row:
    request, answers, clients = (cell.strip() for cell in line.strip("|").split("|"))
    (asked,) = re.findall("`(.*?)`", request)
    return Row(
        _said(asked),
        [_said(answer) for answer in re.findall("`(.*?)`", answers)],
        "for each" in answers,
        {client.strip() for client in clients.split(",")} - {""},
    )


def table() -> list[Row]:
    """All rows of the page's table of requests."""
    text = PAGE.read_text(encoding="utf-8")
    found = re.search(r"^\| request .*\n\|.*\n((?:\|.*\n)+)", text, re.MULTILINE)
    assert found, "no table of requests"
    return [_row(line) for line in found[1].splitlines()]
