"""A run as a MAT-file, for MATLAB, Octave and scipy.io.loadmat."""

import re
from collections.abc import Iterable
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray
from scipy.io import savemat

from laglab.export.tables import Table, tables
from laglab.results.columns import joined
from laglab.results.run import Run

HEADER = b"MATLAB 5.0 MAT-file, written by laglab".ljust(116)
"""SciPy would put the time of writing here; the same run is to give the same file."""

LONGEST_NAME = 63


def write_mat(run: Run, file: BinaryIO) -> None:
    """A struct for each table, a field for each column; `units` has their units, `scenario` TOML.

    All of it is in memory at once.
    """
    contents: dict[str, object] = {"scenario": run.scenario.to_toml()}
    units: dict[str, dict[str, str]] = {}
    for table in tables(run):
        names = _names(column.name for column in table.columns)
        contents[table.name] = _struct(table, names)
        units[table.name] = {names[column.name]: column.unit for column in table.columns}
    contents["units"] = units
    savemat(file, contents, oned_as="column", do_compression=True, long_field_names=True)
    file.seek(0)
    file.write(HEADER)


def _names(columns: Iterable[str]) -> dict[str, str]:
    """What each column is called there: MATLAB's names are of ASCII letters, digits and
    underscores, 63 of them at most; what would then be called alike is numbered."""
    names: dict[str, str] = {}
    for column in columns:
        plain = re.sub(r"[^A-Za-z0-9_]", "_", column)
        name, number = plain[:LONGEST_NAME], 1
        while name in names.values():
            number += 1
            name = f"{plain[: LONGEST_NAME - 5]}_{number}"
        names[column] = name
    return names


def _struct(table: Table, names: dict[str, str]) -> dict[str, object]:
    whole = joined([table.nothing, *table.pieces])
    return {names[name]: _cells(column) for name, column in whole.items()}


def _cells(column: NDArray[np.generic]) -> NDArray[np.generic]:
    """In MATLAB, texts of different lengths are a cell array."""
    return column.astype(object) if column.dtype.kind == "U" else column
