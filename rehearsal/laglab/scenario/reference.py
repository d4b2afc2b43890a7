"""What is generated of the scenario's reference: a page for readers, a JSON Schema for editors."""

import inspect
import json
import math
from collections.abc import Callable, Mapping
from typing import Any

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from laglab.scenario.explain import NOT_SET, spelled
from laglab.scenario.keys import NO_UNIT, Key, keys, rows
from laglab.scenario.model import Scenario

INTRODUCTION = """\
# The scenario file

<!-- Generated from the fields of the tables: python docs/reference/generate.py -->

A scenario is a TOML file of nested tables. A key that is left out has its default, so an empty
file is a scenario too. `laglab scenario NAME` prints one whole, `laglab scenario NAME --explain`
says of every key what it is for. On the command line `--set KEY=VALUE` beats the file, with a
dotted key (`--set link.command.loss=0.1`), and an option of its own beats that.

Units are SI; `ticks` are multiples of `sample_time`, 1 is a number without a dimension, - is no
number. What is not set by default has no limit, or is off. Equations are the paper's.

`laglab scenario --schema > scenario.schema.json` writes a JSON Schema, which lies beside this
page too. With `#:schema ./scenario.schema.json` in the first line of a scenario, editors that
know it (Even Better TOML, taplo) complete the keys and say what they are for.
"""


def page() -> str:
    """Markdown: a section for each kind of table, a row for each key."""
    return "\n".join([INTRODUCTION, *(_section(table, at) for table, at in _tables().items())])


def _tables() -> dict[type, list[str]]:
    """Every kind of table, and where it may stand."""
    found: dict[type, list[str]] = {Scenario: []}
    for row in rows():
        if row.key.table is not None:
            place = f"[[{row.place}]]" if row.key.many else f"[{row.place}]"
            found.setdefault(row.key.table, []).append(f"`{place}`")
    return found


def _section(table: type, places: list[str]) -> str:
    about = (inspect.getdoc(table) or "").split("\n\n")[0].replace("\n", " ")
    heading = ", ".join(places) or "At the top"
    head = ["| key | unit | default | what it is |", "|---|---|---|---|"]
    return "\n".join([f"## {heading}", "", about, "", *head, *map(_line, keys(table)), ""])


def _line(key: Key) -> str:
    if key.table is None:
        default = spelled(key.default) if key.default is None else f"`{spelled(key.default)}`"
    else:
        default = "a table" if key.default else NOT_SET
    return f"| `{key.name}` | {key.unit} | {default} | {key.sentence} |"


class _OfFiles(GenerateJsonSchema):
    """As TOML has it: what is not set is not there, for there is no null."""

    def nullable_schema(self, schema: core_schema.NullableSchema) -> JsonSchemaValue:
        return self.generate_inner(schema["schema"])


def schema() -> str:
    """JSON Schema, draft 2020-12."""
    made = Scenario.model_json_schema(schema_generator=_OfFiles)
    head = {"$schema": GenerateJsonSchema.schema_dialect, "title": "laglab scenario"}
    return json.dumps(head | _told(made), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _told(node: Any) -> Any:
    """Units said in the descriptions; without titles, and without defaults that are no JSON."""
    if isinstance(node, list):
        return [_told(item) for item in node]
    if not isinstance(node, dict):
        return node
    told = {key: _told(value) for key, value in node.items()}
    if isinstance(told.get("title"), str):
        del told["title"]
    if isinstance(unit := told.pop("unit", None), str) and unit != NO_UNIT:
        told["description"] += f" [{unit}]"
    if "default" in told and _no_json(told["default"]):
        del told["default"]
    return told


def _no_json(default: object) -> bool:
    """Null, infinity, and whole tables, whose keys have defaults of their own."""
    return default is None or default == math.inf or isinstance(default, dict)


GENERATED: Mapping[str, Callable[[], str]] = {"scenario.md": page, "scenario.schema.json": schema}
"""The files of `docs/reference/` that `docs/reference/generate.py` writes."""
