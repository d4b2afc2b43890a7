"""What a tick of each filter costs."""

import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from importlib.util import find_spec
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.bench.harness import Bench, Contest, Progress, microseconds
from laglab.bench.result import Figure, Result
from laglab_control import (
    ESTIMATORS,
    Controller,
    DelayedEkf,
    Echo,
    Estimator,
    LiteralPopf,
    ReplayedInputs,
    RobotModel,
    SpeedLimits,
    StationConfig,
    constant_delay,
)

Array = NDArray[np.float64]

OURS = ("ekf", "popf", "popf-exact", "delayed-ekf", "calibrating-ekf")
FILTERPY = "filterpy's EKF"
GUARDED = "delayed-ekf, guarded"
STANDING = SpeedLimits(v_max=1e-9, omega_max=1e-9)
"""The measurements are of a robot that stands still: faster commands would contradict them."""
START = np.zeros(3)
P_0 = np.eye(3) * 1e-6
"""Small enough for popf's gain to stay below its delay limit at every delay measured."""


class DriveRecord(NamedTuple):
    """A made-up record: inputs (N, 2) and measurements (N+1, 3)."""

    inputs: Array
    measurements: Array


Ticks = Callable[[DriveRecord, int], float]
"""Goes through the drive with delay m; gives the seconds a tick took once measurements came."""

DELAYS, CONTROLLER_DELAYS = (4, 40, 400), (2, 20, 200)


def bench(ticks: int) -> Bench:
    """Each filter over the same drive at m = 4, 40 and 400; the controllers at half of that:
    with n = m a measurement is then as old when its command comes into force."""
    alone = filters()
    yardstick = FILTERPY if FILTERPY in alone else OURS[0]
    contests = [
        _contest("the filter alone", yardstick, alone, DELAYS, ticks),
        _contest(
            "filter, extrapolation over n = m ticks, law",
            OURS[0],
            controllers(),
            CONTROLLER_DELAYS,
            ticks,
        ),
    ]
    return Bench("filter", contests, _growths)


def _contest(
    title: str, yardstick: str, contenders: dict[str, Ticks], delays: Sequence[int], ticks: int
) -> Contest:
    drive = make_drive(ticks + max(delays))
    cases = {
        f"m = {m}": {name: partial(go, drive, m) for name, go in contenders.items()} for m in delays
    }
    return Contest(title, microseconds("tick"), yardstick, cases)


def _growths(results: Sequence[Result], _: Progress) -> list[Figure]:
    """How what a tick costs grows from the first delay to the last."""
    return [growth for result in results for growth in _growth(result)]


def _growth(result: Result) -> Iterator[Figure]:
    cases = list(dict.fromkeys(timing.case for timing in result.timings))
    first, last = cases[0], cases[-1]
    for name in dict.fromkeys(timing.name for timing in result.timings):
        growth = result.fastest(last, name) / result.fastest(first, name)
        yield Figure(f"{name}, {last} to {first}", growth, "×")


def make_drive(ticks: int) -> DriveRecord:
    """The robot turns about at random, near where it started."""
    random = np.random.default_rng(1)
    inputs = random.normal(size=(ticks, 2)) * [0.5, 1.0]
    return DriveRecord(inputs, random.normal(size=(ticks + 1, 3)) * 0.1)


def filters() -> dict[str, Ticks]:
    """Ours, the definitions that they must keep up with, and filterpy's EKF where installed."""
    model = RobotModel()
    contenders: dict[str, Ticks] = {
        name: partial(_estimator_tick, ESTIMATORS[name].make(model)) for name in OURS
    }
    contenders["popf, product taken anew"] = partial(_estimator_tick, LiteralPopf(model))
    contenders["EKF rerun over window"] = partial(
        _estimator_tick, DelayedEkf(model, ReplayedInputs(model))
    )
    if find_spec("filterpy"):
        contenders[FILTERPY] = _filterpy_tick
    return contenders


def controllers() -> dict[str, Ticks]:
    """The whole of a tick but for the messages: filter, extrapolation over n = m ticks, law."""
    contenders: dict[str, Ticks] = {name: partial(_controller_tick, name, False) for name in OURS}
    contenders[GUARDED] = partial(_controller_tick, "delayed-ekf", True)
    return contenders


def _estimator_tick(estimator: Estimator[Any], drive: DriveRecord, m: int) -> float:
    arrivals = constant_delay(drive.measurements, m)
    state = estimator.correct(estimator.start(START, P_0), arrivals[0])
    started = 0.0
    for k, u in enumerate(drive.inputs, start=1):
        started = time.perf_counter() if k == m + 1 else started
        state = estimator.correct(estimator.predict(state, u), arrivals[k])
        _ = state.x  # some compute it only now
    return (time.perf_counter() - started) / (len(drive.inputs) - m)


def _controller_tick(name: str, guard: bool, drive: DriveRecord, m: int) -> float:
    config = StationConfig(
        estimator=name,
        limits=STANDING,
        initial_estimate=START,
        initial_covariance=P_0,
        command_delay=m,
        guard=guard,
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


def _filterpy_tick(drive: DriveRecord, m: int) -> float:
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
