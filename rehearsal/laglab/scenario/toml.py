"""TOML, read."""

import tomllib
from typing import Any

DEEPEST = 50
"""Tables and lists in each other; no file of ours has ten."""


def parsed(text: str) -> dict[str, Any]:
    """Raises ValueError: not TOML, or tables and lists in each other beyond all measure."""
    try:
        fields = tomllib.loads(text)
    except RecursionError:
        raise ValueError("nested too deeply") from None
    if _is_deeper(fields, DEEPEST):  # dotted keys nest without the parser's noticing
        raise ValueError("nested too deeply")
    return fields


def _is_deeper(value: object, levels: int) -> bool:
    if not isinstance(value, dict | list):
        return False
    inside = value.values() if isinstance(value, dict) else value
    return levels == 0 or any(_is_deeper(each, levels - 1) for each in inside)
