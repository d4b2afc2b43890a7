"""What a tick of each filter costs, all measured side by side in one go."""

import time
from collections import deque
from collections.abc import Callable, Iterator
from functools import partial
from importlib.util import find_spec
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from rich.table import Table

from laglab_control import (
    ESTIMATORS,
    Controller,
    DelayedEkf,
    Echo,
    Estimator,
    LiteralPopf,
    ReplayedInputs,
    RobotModel,
    StationConfig,
    constant_delay,
)

Array = NDArray[np.float64]

OURS = ("ekf", "popf", "popf-exact", "delayed-ekf")
FILTERPY = "filterpy's EKF"
START = np.zeros(3)
P_0 = np.eye(3) * 1e-6
"""Small enough for popf's gain to stay below its delay limit at every delay measured."""


class Drive(NamedTuple):
    """A made-up record: inputs (N, 2) and measurements (N+1, 3)."""

    inputs: Array
    measurements: Array


Turn = Callable[[Drive, int], float]
"""Goes through the drive with delay m; the seconds that a tick took once measurements came."""


class Timing(NamedTuple):
    """What a tick of one filter costs at each delay [µs]."""

    name: str
    by_delay: dict[int, float]


def make_drive(ticks: int) -> Drive:
    """The robot turns about at random, near where it started."""
    random = np.random.default_rng(1)
    inputs = random.normal(size=(ticks, 2)) * [0.5, 1.0]
    return Drive(inputs, random.normal(size=(ticks + 1, 3)) * 0.1)


def timings(
    contenders: dict[str, Turn], delays: tuple[int, ...], ticks: int, rounds: int
) -> Iterator[Timing]:
    """Round after round in turn, so that a busy machine disturbs all alike; the fastest of a
    filter's turns counts, as the least disturbed one."""
    drive = make_drive(ticks + max(delays))
    fastest = {(name, m): np.inf for name in contenders for m in delays}
    for _ in range(rounds):
        for name, m in fastest:
            fastest[name, m] = min(fastest[name, m], contenders[name](drive, m))
    for name in contenders:
        yield Timing(name, {m: fastest[name, m] * 1e6 for m in delays})


def filters() -> dict[str, Turn]:
    """Ours, the definitions that they must keep up with, and filterpy's EKF where installed."""
    model = RobotModel()
    contenders: dict[str, Turn] = {
        name: partial(_estimator_turn, ESTIMATORS[name].make(model)) for name in OURS
    }
    contenders["popf, product taken anew"] = partial(_estimator_turn, LiteralPopf(model))
    contenders["EKF rerun over window"] = partial(
        _estimator_turn, DelayedEkf(model, ReplayedInputs(model))
    )
    if find_spec("filterpy"):
        contenders[FILTERPY] = _filterpy_turn
    return contenders


def controllers() -> dict[str, Turn]:
    """The whole of a tick but for the messages: filter, extrapolation over n = m ticks, law."""
    return {name: partial(_controller_turn, name) for name in OURS}


def _estimator_turn(estimator: Estimator[Any], drive: Drive, m: int) -> float:
    arrivals = constant_delay(drive.measurements, m)
    state = estimator.correct(estimator.start(START, P_0), arrivals[0])
    started = 0.0
    for k, u in enumerate(drive.inputs, start=1):
        started = time.perf_counter() if k == m + 1 else started
        state = estimator.correct(estimator.predict(state, u), arrivals[k])
        _ = state.x  # some compute it only now
    return (time.perf_counter() - started) / (len(drive.inputs) - m)


def _controller_turn(name: str, drive: Drive, m: int) -> float:
    config = StationConfig(
        estimator=name, initial_estimate=START, initial_covariance=P_0, command_delay=m
    )
    controller = Controller(config)
    arrivals = constant_delay(drive.measurements, m)
    control = controller.answer(controller.start(), arrivals[0])
    coming: deque[tuple[Array, int | None]] = deque([(np.zeros(2), None)] * m)
    in_force: list[tuple[Array, int | None]] = []
    started = 0.0
    for k, measurements in enumerate(arrivals[1:], start=1):
        started = time.perf_counter() if k == m + 1 else started
        coming.append((np.array(control.drive[:2]), k - 1))
        in_force.append(coming.popleft())
        echoes = [Echo(k - m - 1, *in_force[k - m - 1])] if k > m else []
        control = controller.answer(controller.advance(control), measurements, echoes)
    return (time.perf_counter() - started) / (len(drive.inputs) - m)


def _filterpy_turn(drive: Drive, m: int) -> float:
    """The same model and the same ticks; like our `ekf` it takes z_{k-m} for z_k."""
    from filterpy.kalman import ExtendedKalmanFilter

    model, ekf = RobotModel(), ExtendedKalmanFilter(dim_x=3, dim_z=3)
    ekf.x, ekf.P, ekf.R = START, P_0, model.R
    ekf.predict_x = lambda u: setattr(ekf, "x", model.f(ekf.x, u))
    started = 0.0
    for k, u in enumerate(drive.inputs, start=1):
        started = time.perf_counter() if k == m + 1 else started
        W = model.W(ekf.x)
        ekf.F, ekf.Q = model.A(ekf.x, u), W @ model.Q @ W.T
        ekf.predict(u)
        if k >= m:
            z = drive.measurements[k - m]
            ekf.update(z, model.H, model.h, residual=model.innovation)
    return (time.perf_counter() - started) / (len(drive.inputs) - m)


def timings_table(title: str, rows: list[Timing], yardstick: str) -> Table:
    """Microseconds a tick at each delay; how the last delay's compare with the first's, and the
    first's with those of the yardstick."""
    table = Table(title=title, caption=f"the yardstick is {yardstick}", box=None)
    delays = list(rows[0].by_delay)
    unit = next(row.by_delay[delays[0]] for row in rows if row.name == yardstick)
    table.add_column("µs a tick", no_wrap=True)
    for m in delays:
        table.add_column(f"m={m}", justify="right", no_wrap=True)
    table.add_column("last:first", justify="right", no_wrap=True)
    table.add_column("to yardstick", justify="right", no_wrap=True)
    for name, by_delay in rows:
        first, last = by_delay[delays[0]], by_delay[delays[-1]]
        costs = [f"{by_delay[m]:.1f}" for m in delays]
        table.add_row(name, *costs, f"{last / first:.2f}", f"{first / unit:.2f}")
    return table
