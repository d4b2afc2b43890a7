"""Values by dotted keys: what beats a file, from the command line or from a program."""

import re
from collections.abc import Mapping
from typing import Any

from laglab.errors import ScenarioError
from laglab.scenario.toml import parsed

Overrides = Mapping[str, object]
"""Dotted key → value. The tables of a list are counted from 0: `link.event.0.at`."""


def both_ways(**impairments: object) -> Overrides:
    """The same in both directions of the link, and nothing else there."""
    return {"link.command": dict(impairments), "link.measurement": dict(impairments)}


def assignment(text: str) -> tuple[str, object]:
    """`KEY=VALUE`, a dotted key and a TOML value; words that are no TOML are text.

    Raises: ScenarioError.
    """
    key, equals, value = (part.strip() for part in text.partition("="))
    if not equals or not re.fullmatch(r"[\w-]+(\.[\w-]+)*", key):
        raise ScenarioError(f"--set {text}: must be KEY=VALUE, such as link.command_delay=15")
    try:
        read = parsed(f"value = {value}")
    except ValueError as error:
        if value[:1] in {"", "[", "{", '"', "'"}:
            raise ScenarioError(f"--set {text}: {value!r} is no TOML value: {error}") from None
        return key, value
    return key, read["value"] if len(read) == 1 else value


def put(fields: dict[str, Any], key: str, value: object) -> None:
    """Put `value` where the dotted key says, and make the tables on the way.

    Raises: ScenarioError, naming where, when what is on the way is no table.
    """
    if not isinstance(key, str):
        raise ScenarioError(f"{key!r}: must be a key, such as 'link.command_delay'")
    here: Any = fields
    *way, last = key.split(".")
    for depth, part in enumerate(way, start=1):
        here = _inside(here, part, ".".join(way[:depth]))
    if isinstance(here, dict):
        here[last] = of_python(value)
    else:
        here[_number(here, last, key)] = of_python(value)


def of_python(value: Any) -> Any:
    """A copy, for other keys may be put into it; of numpy's numbers and arrays what Python has for
    them."""
    if isinstance(value, Mapping):
        return {key: of_python(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return list(map(of_python, value))
    return value.tolist() if hasattr(value, "tolist") else value


def _inside(here: Any, part: str, place: str) -> Any:
    below = (
        here.setdefault(part, {}) if isinstance(here, dict) else here[_number(here, part, place)]
    )
    if not isinstance(below, dict | list):
        raise ScenarioError(f"{place}: must be a table to have keys, not {below!r}")
    return below


def _number(elements: list[Any], part: str, place: str) -> int:
    if not part.isdecimal() or int(part) >= len(elements):
        last = len(elements) - 1
        raise ScenarioError(f"{place}: must be the number of an element, 0 to {last}, not {part!r}")
    return int(part)
