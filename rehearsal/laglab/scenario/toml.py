"""TOML, read."""

import tomllib
from typing import Any


def parsed(text: str) -> dict[str, Any]:
    """Raises ValueError: not TOML, or tables and lists in each other beyond all measure."""
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise ValueError("nested too deeply") from None
