"""The tables that a run leaves besides its trace, column by column."""

import csv
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TypeVar, get_type_hints

import numpy as np
from numpy.typing import NDArray

from laglab.errors import NoRunError
from laglab_gateway import Row, in_pieces, whole_lines

Array = NDArray[np.float64]
Columns = Mapping[str, NDArray[np.generic]]
"""An array per column; none of them has an entry where nothing was recorded."""

AT_A_TIME = 5_000
"""Rows for which memory always has room."""

T = TypeVar("T")
Column = TypeVar("Column", bound=np.generic)
Lines = list[list[str]]


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


def column_pieces(path: Path, kind: type[Row]) -> Iterator[Columns]:
    """The same, AT_A_TIME rows at a time. Raises NoRunError."""
    hints = get_type_hints(kind)
    if path.exists():
        yield from csv_pieces(path, tuple(hints), lambda lines: _parsed(lines, hints))


def csv_pieces(path: Path, names: Sequence[str], parsed: Callable[[Lines], T]) -> Iterator[T]:
    """What a CSV file of these columns holds, AT_A_TIME rows at a time; a last one that was cut
    short is left out. Raises NoRunError."""
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = csv.reader(whole_lines(file))
            if next(rows, None) != list(names):
                raise NoRunError(f"{path}: expected the columns {','.join(names)}")
            for piece in in_pieces(rows, len(names), AT_A_TIME):
                yield parsed(piece)
    except OSError as error:
        raise NoRunError(f"{path} cannot be read: {error.strerror}") from error
    except (ValueError, OverflowError, csv.Error) as error:
        raise NoRunError(f"{path} cannot be read: {error}") from error


def joined(pieces: Iterable[Mapping[str, NDArray[Column]]]) -> dict[str, NDArray[Column]]:
    """One after the other."""
    whole = list(pieces)
    return {name: np.concatenate([each[name] for each in whole]) for name in whole[0]}


def stride(rows: int, most: int) -> int:
    """The least step through the `rows` that takes no more than `most` of them."""
    return max(1, -(-rows // most))


def thinned(columns: Mapping[str, NDArray[Column]], every: int) -> dict[str, NDArray[Column]]:
    """One row of `every`; copied, as a view would keep all of them in memory."""
    return {name: column[::every].copy() for name, column in columns.items()}


def rising(keys: Array) -> Array:
    """Those that go up, from the first on: a real robot that begins again counts anew."""
    falls = np.flatnonzero(np.diff(keys) < 0)
    return keys[: falls[0] + 1] if len(falls) else keys


def places(keys: Array, wanted: NDArray[np.generic]) -> tuple[NDArray[np.bool_], NDArray[np.intp]]:
    """Which of the `wanted` are among the keys, as far as these go up, and in which rows."""
    keys = rising(keys)
    rows = np.searchsorted(keys, wanted.astype(float))
    there = rows < len(keys)
    there[there] = keys[rows[there]] == wanted[there]
    return there, rows[there]


def beside(keys: Array, others: Columns, key: str, names: Iterable[str]) -> dict[str, Array]:
    """The columns of these `names`, of the rows of `others` whose `key` is among the keys, laid
    beside them; NaN where there is none."""
    there, rows = places(keys, others[key])
    columns = {name: np.full(len(keys), np.nan) for name in names}
    for name, column in columns.items():
        column[rows] = others[name][there]
    return columns


def at_ticks(columns: Mapping[str, NDArray[Column]], ticks: Array) -> dict[str, NDArray[Column]]:
    """The rows of these ticks."""
    there = np.isin(columns["tick"].astype(float), ticks)
    return {name: column[there] for name, column in columns.items()}


def _parsed(lines: Lines, hints: Mapping[str, object]) -> Columns:
    cells = zip(*lines, strict=True) if lines else ((),) * len(hints)
    return {
        name: np.array(column if hint is str else [cell or "nan" for cell in column]).astype(
            _dtype(hint)
        )
        for (name, hint), column in zip(hints.items(), cells, strict=True)
    }


def _dtype(hint: object) -> type[str | int | float]:
    return hint if hint in (str, int) else float
