"""What a robot is to follow: a shape with its measures, or a CSV file."""

import csv
import math
import os
import re
from collections.abc import Callable, Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np

import laglab_control as control
from laglab_control import ConfigError

COLUMNS = ("time", "x", "y", "theta", "v", "omega")

Centre = tuple[float, float]
SHAPES: Mapping[str, tuple[str, Callable[[Centre, float, float], control.Path]]] = {
    "circle": ("radius, speed", control.Circle),
    "eight": ("width, speed", control.Eight),
}
"""By name: what stands in the brackets, and what it makes about a centre."""
KINDS = ", ".join(f"{name}({measures})" for name, (measures, _) in SHAPES.items())


def is_shape(told: str) -> bool:
    """Whether it is written as a shape, and not as a file's name."""
    return re.fullmatch(r"\s*\w+\s*\(.*\)\s*", told) is not None


def reference_path(told: str, centre: Centre) -> control.Path:
    """The path that is told; a shape lies about the centre [m].

    Raises ValueError, for a file that is none naming file and row.
    """
    return _shape(told, centre) if is_shape(told) else _read(told, Path(told).stat().st_mtime_ns)


def resolved(told: str) -> str:
    """The same, a file by its absolute name. Raises ValueError when there is no such path."""
    if is_shape(told):
        _shape(told, (0.0, 0.0))
        return told.strip()
    path = Path(told).resolve()
    try:
        reference_path(str(path), (0.0, 0.0))
    except OSError as error:
        raise ValueError(f"must be {KINDS} or a CSV file; {told}: {error.strerror}") from None
    return str(path)


def anchored(told: str, folder: Path) -> str:
    """A file relative to the folder, as one that can be opened."""
    return told if is_shape(told) else str(folder / told)


def relative(told: str, folder: Path) -> str:
    """An absolute file as seen from the folder."""
    return told if is_shape(told) else os.path.relpath(told, folder.resolve())


def _shape(told: str, centre: Centre) -> control.Path:
    name, _, inside = told.strip().rstrip(")").partition("(")
    if name.strip() not in SHAPES:
        raise ValueError(f"must be {KINDS} or a CSV file, not {told!r}")
    measures, make = SHAPES[name.strip()]
    try:
        first, second = (float(number) for number in inside.split(","))
        return make(centre, first, second)
    except ValueError as error:
        why = str(error) if isinstance(error, ConfigError) else f"{measures} must be numbers"
        raise ValueError(f"must be {name.strip()}({measures}), not {told!r}: {why}") from None


@lru_cache(maxsize=8)
def _read(name: str, _: int) -> control.Path:
    """Read once, but for a file whose time of change, the second argument, is another one."""
    try:
        with Path(name).open(encoding="utf-8-sig", newline="") as file:
            rows = csv.DictReader(file)
            if missing := set(COLUMNS) - set(rows.fieldnames or ()):
                told = ", ".join(each for each in COLUMNS if each in missing)
                raise ValueError(f"{name}: a path has the columns {','.join(COLUMNS)}; no {told}")
            table = [_numbers(name, rows.line_num, row) for row in rows]
    except (UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f"{name}: not a readable CSV file: {error}") from None
    try:
        numbers = np.array(table, dtype=float).reshape(-1, len(COLUMNS))
        return control.Waypoints(numbers[:, 0], numbers[:, 1:])
    except ConfigError as error:
        raise ValueError(f"{name}: {error}") from None


def _numbers(name: str, line: int, row: Mapping[str, str | None]) -> list[float]:
    try:
        numbers = [float(row[column] or "") for column in COLUMNS]
    except ValueError:
        numbers = [math.nan]
    if not all(map(math.isfinite, numbers)):
        raise ValueError(f"{name}: line {line}: must be {len(COLUMNS)} finite numbers")
    return numbers
