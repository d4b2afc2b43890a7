"""From cells' descriptions to their tables: a pure function, wherever it is called."""

from collections.abc import Mapping, Sequence

import msgspec
import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from laglab.scenario.explain import spelled
from laglab.studies.judged import ALARMS, Judgements
from laglab.studies.sweep.cells.cell import Cell
from laglab.studies.sweep.cells.ways import judged

DESCRIPTION = b"laglab.cell"
"""Where the table's metadata tell, as JSON, what the cell is."""


def computed(cells: Sequence[Cell]) -> list[pa.Table]:
    """Of each, a row for each of its seeds, in their order. Raises RunError."""
    return [table(*each) for each in zip(cells, judged(cells), strict=True)]


def table(cell: Cell, became: Judgements) -> pa.Table:
    """The grid's values, the seeds and their starts, and what became of them; null for nothing."""
    rows = len(cell.seeds)
    x, y, theta = cell.starts().T
    left_out = set(ALARMS) - set(cell.also)
    columns: Mapping[str, pa.Array] = {
        **{key: pa.array([column_value(value)] * rows) for key, value in cell.grid.items()},
        "seed": pa.array(cell.seeds, pa.int64()),
        "start_x": pa.array(x),
        "start_y": pa.array(y),
        "start_theta": pa.array(theta),
        **{
            name: _column(name, values)
            for name, values in became._asdict().items()
            if name not in left_out
        },
    }
    told = {"grid": cell.grid, "radius": cell.radius, "origin": cell.origin}
    return pa.table(columns).replace_schema_metadata({DESCRIPTION: msgspec.json.encode(told)})


def column_value(value: object) -> object:
    """What has no type of column of its own, as in a file."""
    return value if isinstance(value, bool | int | float | str) else spelled(value)


def _column(name: str, values: NDArray[np.generic]) -> pa.Array:
    if name == "converged":
        return pa.array(values)
    floats = pa.array(values, pa.float64(), from_pandas=True)  # NaN is null
    return floats.cast(pa.int64()) if name == "diverged_tick" else floats
