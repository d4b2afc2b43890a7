"""What an estimator must keep: `laglab_control.Estimator`, a row each."""

import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.check.finding import INTERFACE, Check, NothingToHoldError, NotSoError, need
from laglab.check.record import Record, drive
from laglab.results.nees import nees
from laglab.results.numbers import pose_difference
from laglab_control import (
    ESTIMATORS,
    Estimator,
    Guard,
    Measured,
    RobotModel,
    StampError,
    State,
    chi_square_bound,
)
from laglab_control.estimators import claim_of, pose_of

Array = NDArray[np.float64]
MODEL = RobotModel()
TICKS = 120
DELAYS = (0, 1, 7, 20, 60)
SEEDS, LATE = 20, 10
"""The runs over which NEES is averaged: how many, and their measurements' delay [ticks]."""
IMPROBABLE = 1e-3
"""The probability that a filter which is right about itself is outside the bounds."""
EXACT = 5e-3
"""[m, rad] Without noise, an estimate is off by less."""
AGREES = 0.1
"""[standard deviations claimed] Two optimal filters differ by less."""


class Subject(NamedTuple):
    """Made anew for each check."""

    estimator: Estimator[State]
    optimal: bool
    """Whether it claims to be as good as `delayed-ekf`."""


Arrivals = Callable[[int], Sequence[Measured]]


def _run(estimator: Estimator[Any], record: Record, arrivals: Arrivals) -> list[State]:
    """The states of all ticks."""
    state = estimator.correct(estimator.start(record.x.copy(), record.P), arrivals(0), ())
    states = [state]
    for k, u in enumerate(record.inputs, start=1):
        state = estimator.correct(estimator.predict(state, u.copy()), arrivals(k), ())
        states.append(state)
    return states


def _late(record: Record, m: int) -> Arrivals:
    """Each m ticks late."""
    return lambda k: [record.measured(k - m)] if k >= m else []


def _poses(states: Sequence[State]) -> Array:
    """(ticks, 3); NaN where there is none."""
    poses = [pose_of(state) for state in states]
    return np.array([np.full(3, np.nan) if pose is None else pose for pose in poses])


def _claims(states: Sequence[State]) -> Array:
    claims = [claim_of(state) for state in states]
    return np.array([np.full((3, 3), np.nan) if P is None else P for P in claims])


def _told(state: State) -> tuple[bytes, bytes]:
    """All that can be seen of it."""
    x, P = state.x, state.P
    return (b"" if x is None else x.tobytes()), (b"" if P is None else P.tobytes())


def interface(subject: Subject) -> str:
    """start, predict, correct, a state of every tick, and what else it has."""
    record = drive(MODEL, TICKS, seed=1)
    states = _run(subject.estimator, record, _late(record, 3))
    _try_the_optional(subject.estimator, states[-1], record)
    unwatched = ""
    if subject.estimator.is_watchable:
        _run(Guard(subject.estimator, MODEL), record, _late(record, 3))
    else:
        unwatched = "; without innovation: run it with estimator.guard = false"
    size = len(states[-1].x) if states[-1].x is not None else 0
    return f"a state of {size} components, followed over {TICKS} ticks{unwatched}"


def _try_the_optional(estimator: Estimator[State], state: State, record: Record) -> None:
    """Whatever it has besides what it must."""
    estimator.innovation(state)
    estimator.ahead(state, list(record.inputs[-3:]))
    estimator.expect(state, TICKS)
    estimator.learned(state)
    estimator.warning(state)
    estimator.restart(state, record.x.copy(), record.P)
    robot = estimator.calibrated(state, MODEL)
    for u in record.inputs[-3:]:
        robot.way(u)


def pure(subject: Subject) -> str:
    """The same answer twice, and nothing that it was given is changed."""
    estimator, record = subject.estimator, drive(MODEL, TICKS, seed=2)
    x, P = record.x.copy(), record.P
    state = estimator.correct(estimator.start(x, P), (), ())
    for k, u in enumerate(record.inputs, start=1):
        before, given = _told(state), [record.measured(max(k - 3, 0))]
        once, again = (estimator.predict(state, u) for _ in range(2))
        need(_told(once) == _told(again), f"predict answers twice differently at tick {k}")
        need(_told(state) == before, f"predict changes the state that it is given, of tick {k - 1}")
        before = _told(once)
        state, again = (estimator.correct(once, given, ()) for _ in range(2))
        need(_told(state) == _told(again), f"correct answers twice differently at tick {k}")
        need(_told(once) == before, f"correct changes the state that it is given, of tick {k}")
        same = np.array_equal(given[0].z, record.measurements[given[0].tick])
        need(same and np.array_equal(u, record.inputs[k - 1]), "it changes what it is told")
    need(np.array_equal(x, record.x) and np.array_equal(P, record.P), "it changes its prior")
    alone = _run(estimator, record, lambda k: [record.measured(max(k - 3, 0))] if k else [])[-1]
    need(_told(state) == _told(alone), "calls that were made twice leave something behind")
    return "each call twice, over a whole run"


def order(subject: Subject) -> str:
    """Measurements that come together are used in the order in which they were sampled."""
    record = drive(MODEL, TICKS, seed=3)

    def together(k: int) -> list[Measured]:
        return [record.measured(s) for s in range(k - 5, k)] if k and k % 5 == 0 else []

    given = _run(subject.estimator, record, together)
    turned = _run(subject.estimator, record, lambda k: together(k)[::-1])
    apart = float(np.nanmax(np.abs(_poses(given) - _poses(turned)), initial=0.0))
    need(apart < 1e-9, f"another order of five that come together makes {apart:.2g} m or rad")
    return "five that come together, in either order"


def repeats(subject: Subject) -> str:
    """A second one of the same tick is not used."""
    record = drive(MODEL, TICKS, seed=4)

    def twice(k: int) -> list[Measured]:
        new = [record.measured(k - 3)] if k >= 3 else []
        return [*([record.measured(k - 9)] if k >= 9 else []), *new, *new]

    once = _run(subject.estimator, record, _late(record, 3))
    again = _run(subject.estimator, record, twice)
    apart = float(np.nanmax(np.abs(_poses(once) - _poses(again)), initial=0.0))
    need(apart < 1e-9, f"repeated measurements make {apart:.2g} m or rad")
    return "each measurement three times, once again later"


def delays(subject: Subject) -> str:
    """A late measurement says where the robot was, not where it is."""
    record = drive(MODEL, TICKS, seed=5, noise=False)
    for m in DELAYS:
        poses = _poses(_run(subject.estimator, record, _late(record, m)))
        off = np.nanmax(np.abs(pose_difference(poses, record.poses)))
        need(off < EXACT, f"without noise it is off by {off:.2g} m or rad, {m} ticks late")
    return f"{', '.join(map(str, DELAYS))} ticks; without noise it is right to {EXACT:g}"


def stamps(subject: Subject) -> str:
    """What was sampled before tick 0 or after the present is an error."""
    record = drive(MODEL, 5, seed=6)
    state = _run(subject.estimator, record, _late(record, 0))[-1]
    for tick in (-1, 6):
        with suppress(StampError):
            subject.estimator.correct(state, [Measured(tick, record.poses[0])], ())
            raise NotSoError(f"tick {tick} at tick 5 raises no StampError")
    return "StampError for ticks -1 and k + 1"


def optimum(subject: Subject) -> str:
    """Who claims to be the optimum agrees with `delayed-ekf`."""
    if not subject.optimal:
        raise NothingToHoldError("it does not claim to be (optimal = True)")
    record, random = drive(MODEL, TICKS, seed=7), np.random.default_rng(7)
    came = np.arange(TICKS + 1) + random.integers(0, 20, TICKS + 1)

    def arrivals(k: int) -> list[Measured]:
        return [record.measured(s) for s in np.flatnonzero(came == k).tolist()]

    best = _run(ESTIMATORS["delayed-ekf"].make(MODEL), record, arrivals)
    own = _run(subject.estimator, record, arrivals)
    sigma = np.sqrt(np.diagonal(_claims(best), axis1=1, axis2=2))
    apart = float((np.abs(pose_difference(_poses(own), _poses(best))) / sigma).max())
    need(apart < AGREES, f"up to {apart:.2g} standard deviations from delayed-ekf")
    return f"within {apart:.1g} standard deviations of delayed-ekf, whatever the order"


def honest(subject: Subject) -> str:
    """NEES: the covariance that it claims is that of its error."""
    values = []
    for seed in range(SEEDS):
        record = drive(MODEL, TICKS, seed=100 + seed)
        states = _run(subject.estimator, record, _late(record, LATE))
        values.append(nees(pose_difference(_poses(states), record.poses), _claims(states))[LATE:])
    known = [each[np.isfinite(each)] for each in values]
    if not any(len(each) for each in known):
        raise NothingToHoldError("it claims nothing")
    mean = float(np.mean(np.concatenate(known)))
    low, high = (chi_square_bound(tail, 3 * SEEDS) / SEEDS for tail in (1 - IMPROBABLE, IMPROBABLE))
    need(low <= mean <= high, f"NEES {mean:.2f} on average, not within {low:.1f} to {high:.1f}")
    return f"NEES {mean:.2f} on average of {SEEDS} runs, 3 is right"


def cost(subject: Subject) -> str:
    """A tick takes less time than it lasts."""
    estimator, record = subject.estimator, drive(MODEL, TICKS, seed=8)
    arrivals, state = _late(record, LATE), estimator.start(record.x, record.P)
    took = []
    for k, u in enumerate(record.inputs, start=1):
        began = time.perf_counter()
        state = estimator.correct(estimator.predict(state, u), arrivals(k), ())
        _ = state.x, state.P
        took.append(time.perf_counter() - began)
    median = float(np.median(took))
    need(median < MODEL.sample_time, f"{1e3 * median:.1f} ms a tick, which lasts 10 ms")
    return f"{1e6 * median:.0f} µs a tick (median)"


CHECKS: Mapping[str, Check[Subject]] = {
    INTERFACE: interface,
    "pure": pure,
    "order": order,
    "repeats": repeats,
    "delays": delays,
    "stamps": stamps,
    "optimum": optimum,
    "NEES": honest,
    "cost": cost,
}
