"""The tables that a run leaves besides its trace, column by column."""

import csv
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import get_type_hints

import numpy as np
from numpy.typing import NDArray

from laglab.errors import NoRunError
from laglab_gateway import Row

Columns = Mapping[str, NDArray[np.generic]]
"""An array per column; none of them has an entry where nothing was recorded."""

AT_A_TIME = 5_000
"""Rows for which memory always has room."""


def columns_of(rows: Sequence[Row], kind: type[Row]) -> Columns:
    """The rows' columns: texts, whole numbers, doubles (NaN for nothing)."""
    cells = zip(*rows, strict=True) if rows else ((),) * len(kind._fields)
    return {
        name: np.array([np.nan if cell is None else cell for cell in column], dtype=_dtype(hint))
        for (name, hint), column in zip(get_type_hints(kind).items(), cells, strict=True)
    }


def read_columns(path: Path, kind: type[Row]) -> Columns:
    """Of a CSV file, which a run leaves only where there was something to say.

    Raises: NoRunError.
    """
    return joined([columns_of([], kind), *column_pieces(path, kind)])


def joined(pieces: Iterable[Columns]) -> Columns:
    """One after the other."""
    whole = list(pieces)
    return {name: np.concatenate([each[name] for each in whole]) for name in whole[0]}


def column_pieces(path: Path, kind: type[Row]) -> Iterator[Columns]:
    """The same, so many rows at a time; a row that was cut short is left out."""
    if not path.exists():
        return
    hints = get_type_hints(kind)
    try:
        with path.open(newline="", encoding="utf-8") as file:
            lines = csv.reader(file)
            if next(lines, None) != list(hints):
                raise NoRunError(f"{path}: expected the columns {','.join(hints)}")
            while piece := list(islice(lines, AT_A_TIME)):
                if whole := [line for line in piece if len(line) == len(hints)]:
                    yield _parsed(whole, hints)
    except (OSError, ValueError, csv.Error) as error:
        raise NoRunError(f"{path} cannot be read: {error}") from error


def _parsed(lines: list[list[str]], hints: Mapping[str, object]) -> Columns:
    cells = zip(*lines, strict=True)
    return {
        name: np.array(column if hint is str else [cell or "nan" for cell in column]).astype(
            _dtype(hint)
        )
        for (name, hint), column in zip(hints.items(), cells, strict=True)
    }


def _dtype(hint: object) -> type[str | int | float]:
    return hint if hint in (str, int) else float
