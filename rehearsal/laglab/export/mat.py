"""A run as a MAT-file, for MATLAB, Octave and scipy.io.loadmat."""

import re
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray
from scipy.io import savemat

from laglab.export.tables import Table, tables
from laglab.results.columns import joined
from laglab.results.run import Run

HEADER = b"MATLAB 5.0 MAT-file, written by laglab".ljust(116)
"""SciPy would put the time of writing here; the same run is to give the same file."""


def write_mat(run: Run, file: BinaryIO) -> None:
    """A struct for each table, a field for each column; `units` has their units, `scenario` TOML.

    All of it is in memory at once.
    """
    contents: dict[str, object] = {"scenario": run.scenario.to_toml()}
    units: dict[str, dict[str, str]] = {}
    for table in tables(run):
        contents[table.name] = _struct(table)
        units[table.name] = {_named(column.name): column.unit for column in table.columns}
    contents["units"] = units
    savemat(file, contents, oned_as="column", do_compression=True, long_field_names=True)
    file.seek(0)
    file.write(HEADER)


def _struct(table: Table) -> dict[str, object]:
    whole = joined([table.nothing, *table.pieces])
    return {_named(name): _cells(column) for name, column in whole.items()}


def _cells(column: NDArray[np.generic]) -> NDArray[np.generic]:
    """In MATLAB, texts of different lengths are a cell array."""
    return column.astype(object) if column.dtype.kind == "U" else column


def _named(column: str) -> str:
    """MATLAB's names are of letters, digits and underscores, and 63 of them at most."""
    return re.sub(r"\W", "_", column)
