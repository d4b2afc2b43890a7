"""An estimator over a finished record, with no loop around it."""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np

from laglab_control.estimators.interface import Estimator, Measured
from laglab_control.estimators.kalman import normalised_squared
from laglab_control.model import Matrix, Vector


class Replay(NamedTuple):
    """What the estimator said at ticks 0 ... N: NaN where it said nothing, or after it diverged."""

    estimates: Vector
    """(N+1, d)."""
    covariances: Matrix
    """(N+1, d, d)."""
    nis: Vector
    """(N+1,): the normalised innovation squared v^T S^-1 v of the newest measurement used."""


def replay(
    estimator: Estimator[Any],
    x: Vector,
    P: Matrix,
    inputs: Vector,
    arrivals: Iterable[Sequence[Measured]],
) -> Replay:
    """Feed the record to the estimator, from the prior x (d,), P (d, d) of tick 0.

    `inputs` (N, p): row k was in force on [t_k, t_{k+1}). `arrivals`: N+1 lists, the k-th of the
    measurements that arrived at tick k. Raises ValueError when the lengths do not fit, and
    StampError for a measurement from before tick 0 or from the future.
    """
    shape = (len(inputs) + 1, len(x))
    answer = Replay(*(np.full(s, np.nan) for s in (shape, (*shape, len(x)), shape[:1])))
    state = estimator.start(x, P)
    with np.errstate(over="ignore", invalid="ignore"):  # what diverges is cut off below
        for k, measurements in zip(range(len(inputs) + 1), arrivals, strict=True):
            state = estimator.predict(state, inputs[k - 1]) if k > 0 else state
            state = estimator.correct(state, measurements)
            if state.x is None:
                continue
            if not np.all(np.isfinite(state.x)):
                break
            answer.estimates[k] = state.x
            answer.covariances[k] = np.nan if state.P is None else state.P
            innovation = estimator.innovation(state) if measurements else None
            answer.nis[k] = normalised_squared(innovation) if innovation else np.nan
    return answer


def constant_delay(measurements: Vector, m: int) -> list[list[Measured]]:
    """The arrivals of `measurements` (N+1, q), z_k in row k, each exactly m ticks late."""
    return [
        [Measured(k - m, measurements[k - m])] if k >= m else [] for k in range(len(measurements))
    ]
