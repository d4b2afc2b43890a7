"""The trace: one row a tick, in numbers that read back to the same double."""

import csv
from pathlib import Path
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from laglab_gateway.errors import TraceError


class TraceRow(NamedTuple):
    """Tick k: pose (None of a real robot), sample z_k, estimate of k (None without a filter), u_k
    as sent (None when it had not come by the end of the tick), u in force.

    Of a real robot, sample and u in force are what it reports, None when it does not.
    """

    tick: int
    time: float
    x: float | None
    y: float | None
    theta: float | None
    x_meas: float | None
    y_meas: float | None
    theta_meas: float | None
    x_est: float | None
    y_est: float | None
    theta_est: float | None
    v_sent: float | None
    omega_sent: float | None
    v: float | None
    omega: float | None


Trace: TypeAlias = dict[str, NDArray[np.float64]]
"""One array per column of the trace; an empty cell is NaN."""

HEADER = ",".join(TraceRow._fields) + "\n"


def format_row(row: tuple[int | float | str | None, ...]) -> str:
    """`repr` of a float is the shortest text that reads back to the same double."""
    cells = ["" if cell is None else cell if isinstance(cell, str) else repr(cell) for cell in row]
    return ",".join(cells) + "\n"


def read_trace(path: Path) -> Trace:
    """The columns of a trace file, each of shape (ticks + 1,).

    Raises:
        TraceError: the file is missing, has other columns, or holds no row.
    """
    try:
        with path.open(newline="") as file:
            header, *rows = csv.reader(file)
            cells = [[float(cell or "nan") for cell in row] for row in rows]
    except (OSError, ValueError) as error:
        raise TraceError(f"{path} is not a readable trace: {error}") from error
    if header != list(TraceRow._fields) or not cells:
        raise TraceError(f"{path} is not a trace: expected the columns {HEADER.strip()} and rows")
    return dict(zip(header, np.array(cells).T, strict=True))
