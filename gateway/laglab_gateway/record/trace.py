"""The trace: one row a tick, in numbers that read back to the same double."""

import csv
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from laglab_gateway.errors import TraceError
from laglab_gateway.record.text import in_pieces, whole_lines


class TraceRow(NamedTuple):
    """Tick k: time [s], pose (None of a real robot), sample z_k and estimate of k (None without a
    filter) [m, m, rad], u_k as sent (None when it had not come by the end of the tick) and u in
    force [m/s, rad/s].

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


def read_trace(path: Path) -> Trace:
    """The columns of a trace file, each of shape (ticks + 1,).

    Raises:
        TraceError: the file is missing, has other columns, or holds no row.
    """
    pieces = list(trace_pieces(path))
    return {name: np.concatenate([piece[name] for piece in pieces]) for name in TraceRow._fields}


def trace_pieces(path: Path, most: int = 5_000) -> Iterator[Trace]:
    """A trace of any length, at `most` rows at a time; a last row that was cut short is left out.

    Raises: TraceError, as `read_trace`.
    """
    try:
        with path.open(newline="") as file:
            rows = csv.reader(whole_lines(file))
            if next(rows, None) != list(TraceRow._fields):
                raise TraceError(f"{path} is not a trace: expected the columns {HEADER.strip()}")
            empty = True
            for piece in in_pieces(rows, len(TraceRow._fields), most):
                empty = False
                yield _columns(piece)
    except OSError as error:
        raise TraceError(f"{path} cannot be read: {error.strerror}") from error
    except (ValueError, csv.Error) as error:
        raise TraceError(f"{path} is not a readable trace: {error}") from error
    if empty:
        raise TraceError(f"{path} holds no row: the run ended before its first tick was over")


def _columns(rows: list[list[str]]) -> Trace:
    table = np.array([[float(cell or "nan") for cell in row] for row in rows], dtype=np.float64)
    return dict(zip(TraceRow._fields, table.T, strict=True))


def trace_of(rows: Sequence[TraceRow]) -> Trace:
    """The columns of these rows."""
    table = np.array(rows, dtype=np.float64).reshape(-1, len(TraceRow._fields))
    return dict(zip(TraceRow._fields, table.T, strict=True))
