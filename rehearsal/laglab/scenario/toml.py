"""TOML, read: what ships under a name, or somebody's file."""

import tomllib
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from laglab.errors import LaglabError

DEEPEST = 50
"""Levels of tables and lists in each other; no file of ours has ten."""


def parsed(text: str) -> dict[str, Any]:
    """Raises ValueError: not TOML, or tables and lists nested deeper than DEEPEST."""
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


def shipped_in(folder: Traversable) -> list[str]:
    """The names of what comes with the package there."""
    names = (Path(file.name) for file in folder.iterdir())
    return sorted(name.stem for name in names if name.suffix == ".toml")


def read_by_name(
    reference: str, folder: Traversable, what: str, error: type[LaglabError]
) -> tuple[str, Path]:
    """The text and the path of what ships under that name, or of a file. Raises `error`."""
    shipped = shipped_in(folder)
    path = Path(str(folder / f"{reference}.toml")) if reference in shipped else Path(reference)
    try:
        return path.read_text(encoding="utf-8-sig"), path
    except (FileNotFoundError, IsADirectoryError):
        raise error(
            f"{reference}: no such {what}; shipped: {', '.join(shipped)}; or give a path to a TOML "
            "file"
        ) from None
    except (OSError, ValueError) as problem:
        raise error(f"{reference}: not a readable TOML file: {problem}") from None
