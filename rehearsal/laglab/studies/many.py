"""Runs that differ only in seed and start, all at once: the fleet FMU, and a batch of controllers.

The order of a tick is that of docs/tick.md, the numbers are those of the runs one by one.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from laglab.runs.robot_side import robot_parameters
from laglab.runs.station_side import station_config
from laglab.scenario import Scenario
from laglab_control.batch import BATCHED, BatchController, Pose, Speeds
from laglab_fmu import Fleet
from laglab_gateway import IDEAL, Safety
from laglab_gateway.drive import FASTEST

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Many:
    """What the runs leave, tick by tick; of what came after a run's end nothing counts."""

    truth: Array
    """(ticks + 1, 3, robots) [m, m, rad]."""
    estimates: Array
    """The same; NaN where there is none."""
    P: Array
    """(ticks + 1, 6, robots), the upper triangle of what is claimed; NaN where nothing is."""
    applied: Array
    """(ticks + 1, 2, robots) [m/s, rad/s]."""
    last_tick: NDArray[np.int64]
    """(robots,)"""
    diverged: NDArray[np.bool_]
    """(robots,): the run ended because the estimate did."""
    unsure: NDArray[np.bool_]
    """(robots,): something happened that a batch cannot express; run them one by one."""


def why_one_by_one(scenario: Scenario) -> str | None:
    """What a batch cannot express of such runs; None: nothing."""
    kind, link = scenario.estimator.kind, scenario.link
    if kind not in BATCHED:
        return f"{kind} has no form for many robots"
    if scenario.plant.event:
        return "the fleet's robots cannot be moved by hand"
    if link.replay or link.event or link.command != IDEAL or link.measurement != IDEAL:
        return "the link does not deliver everything on time"
    return None if scenario.safety.link_timeout else "the robot stops at once"


def run_many(scenarios: Sequence[Scenario]) -> Many:
    """All of them to the end."""
    scenario, robots = scenarios[0], len(scenarios)
    last, link = scenario.must_end(), scenario.link
    starts = np.array([each.first_estimate() for each in scenarios]).T
    controller = BatchController(
        station_config(scenario), starts, link.measurement_delay, exact=not scenario.noise
    )
    many = _unwritten(last, robots)
    parameters = [robot_parameters(each) for each in scenarios]
    with Fleet.open(parameters) as fleet, np.errstate(all="ignore"):  # what diverges overflows
        _run(fleet, controller, scenario, many)
    return many


def _unwritten(last: int, robots: int) -> Many:
    return Many(
        truth=np.empty((last + 1, 3, robots)),
        estimates=np.full((last + 1, 3, robots), np.nan),
        P=np.full((last + 1, 6, robots), np.nan),
        applied=np.empty((last + 1, 2, robots)),
        last_tick=np.full(robots, last),
        diverged=np.zeros(robots, np.bool_),
        unsure=np.zeros(robots, np.bool_),
    )


def _run(fleet: Fleet, controller: BatchController, scenario: Scenario, many: Many) -> None:
    control = controller.start()
    last = len(many.truth) - 1
    n, m = scenario.link.command_delay, scenario.link.measurement_delay
    measurements = deque[Pose]()
    commands = deque([control.drive.speeds] * n)
    wheels = Wheels(scenario)
    for k in range(last + 1):
        many.truth[k] = fleet.readings[:, :3].T
        measurements.append(Pose(*fleet.readings[:, 3:6].T.copy()))
        arrived = measurements.popleft() if k >= m else None
        control = controller.answer(controller.advance(control) if k else control, arrived)
        if control.pose is not None and control.P is not None:  # as the station reports it
            many.estimates[k], many.P[k] = control.pose, control.P
        commands.append(control.drive.speeds)
        applied = commands.popleft()
        many.applied[k] = applied
        many.unsure[:] |= refused(control.drive.speeds, scenario.safety)
        ends = control.lost & ~many.diverged
        many.last_tick[ends] = k
        many.diverged[:] |= ends
        if k < last:
            fleet.step(wheels.turning(applied))
    if control.found is not None:
        many.unsure[:] |= control.found.acts


def refused(speeds: Speeds, safety: Safety) -> NDArray[np.bool_]:
    """The robots that would not follow such a command."""
    v_limit, omega_limit = safety.v_limit or FASTEST, safety.omega_limit or FASTEST
    allowed = (np.abs(speeds.v) <= min(v_limit, FASTEST)) & (
        np.abs(speeds.omega) <= min(omega_limit, FASTEST)
    )
    return ~allowed


class Wheels:
    """(1) solved for the wheel speeds of many robots."""

    def __init__(self, scenario: Scenario) -> None:
        self._radius, self._half_track = scenario.plant.wheel_radius, scenario.plant.track / 2

    def turning(self, speeds: Speeds) -> Array:
        """(robots, 2) [rad/s], column-major as the FMU reads them."""
        turn = speeds.omega * self._half_track
        return np.stack((speeds.v - turn, speeds.v + turn)).T / self._radius
