"""Runs that differ only in seed and start, all at once: the fleet FMU, and a batch of controllers.

The order of a tick is that of docs/tick.md, the numbers are those of the runs one by one. Where the
link does more than delay, what happens when is found out first, seed by seed (`schedule`).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.runs.plant.shipped import robot_parameters
from laglab.runs.robot_side import link_fates
from laglab.runs.station_side import station_config
from laglab.scenario import Scenario
from laglab.studies.many.schedule import schedule_of
from laglab_control.batch import BATCHED, BatchController, Pose, Speeds, Symmetric
from laglab_control.batch.impaired import ImpairedController, Timetable
from laglab_gateway.drive import FASTEST, Safety

if TYPE_CHECKING:
    from laglab_fmu import Fleet

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


def run_many(scenarios: Sequence[Scenario]) -> Many:
    """All of them to the end. There must be no reason to run them one by one (`why_one_by_one`)."""
    from laglab_fmu import Fleet  # loads FMPy

    scenario = scenarios[0]
    many = _unwritten(scenario.must_end(), len(scenarios))
    parameters = [robot_parameters(each) for each in scenarios]
    with Fleet.open(parameters) as fleet, np.errstate(all="ignore"):  # what diverges overflows
        way = OnTime(scenarios) if is_ideal(scenario) else Impaired(scenarios)
        _run(fleet, scenario, way.answer, many)
    return many


def why_one_by_one(scenario: Scenario) -> str | None:
    """Why a run of that scenario cannot be one of many; None when it can."""
    link = scenario.link
    reasons = {
        f"there is no {scenario.estimator.kind} for many robots": (
            scenario.estimator.kind not in BATCHED
        ),
        f"there is no law {scenario.law.kind} for many robots": scenario.law.kind != "polar",
        f"of {scenario.plant.called} there is one a run, and no fleet (plant)": (
            not scenario.plant.has_fleet
        ),
        "there are no plans for many robots (plan)": link.plan > 0,
        "there is no play-out for many robots (playout)": bool(
            link.playout.command or link.playout.measurement
        ),
        "somebody moves the robot (plant.event)": bool(scenario.plant.event),
        "the run does not end by itself (duration)": scenario.last_tick is None,
        "the clock paces it (pace)": scenario.pace != "lockstep",
        "what the link does depends on the bytes (bit_error_rate, bandwidth)": (
            link.replay is None
            and any(
                each.reads_bytes
                for each in (link.command, link.measurement, *[event.link for event in link.event])
            )
        ),
    }
    return next((reason for reason, holds in reasons.items() if holds), None)


def is_ideal(scenario: Scenario) -> bool:
    """Whether the link delivers everything on time, and the robot never has to stop by itself."""
    return not link_fates(scenario) and scenario.safety.link_timeout > 0


def _unwritten(last: int, robots: int) -> Many:
    return Many(
        truth=np.empty((last + 1, 3, robots)),
        estimates=np.empty((last + 1, 3, robots)),
        P=np.empty((last + 1, 6, robots)),
        applied=np.empty((last + 1, 2, robots)),
        last_tick=np.full(robots, last),
        diverged=np.zeros(robots, np.bool_),
        unsure=np.zeros(robots, np.bool_),
    )


def _starts(scenarios: Sequence[Scenario]) -> Array:
    """The first estimates (3, robots)."""
    return np.array([each.first_estimate() for each in scenarios]).T


class Answers(NamedTuple):
    """Of all robots at a tick."""

    pose: Pose | None
    P: Symmetric | None
    sent: Speeds
    applied: Speeds
    lost: NDArray[np.bool_]
    """The robots whose estimate has diverged."""
    acts: NDArray[np.bool_]
    """The robots whose guard would have acted by now."""


def _run(fleet: Fleet, scenario: Scenario, answer: Callable[[Pose], Answers], many: Many) -> None:
    """`answer` is given what is sampled at each tick."""
    wheels, last = Wheels(scenario), len(many.truth) - 1
    for k in range(last + 1):
        many.truth[k] = fleet.readings[:, :3].T
        pose, P, sent, applied, lost, acts = answer(Pose(*fleet.readings[:, 3:6].T.copy()))
        if pose is None or P is None:  # as the station reports it
            many.estimates[k], many.P[k] = np.nan, np.nan
        else:
            _keep(many.estimates[k], pose)
            _keep(many.P[k], P)
        _keep(many.applied[k], applied)
        many.unsure[:] |= ~many.diverged & (acts | refused(sent, scenario.safety))
        ends = lost & ~many.diverged
        many.last_tick[ends] = k
        many.diverged[:] |= ends
        if k < last:
            fleet.step(wheels.turning(applied))


def _keep(rows: Array, values: Iterable[Array]) -> None:
    for row, each in zip(rows, values, strict=True):
        row[:] = each


class OnTime:
    """Over a link that delivers everything on time."""

    def __init__(self, scenarios: Sequence[Scenario]) -> None:
        scenario, self._measurement_delay = scenarios[0], scenarios[0].link.measurement_delay
        self._controller = BatchController(
            station_config(scenario),
            _starts(scenarios),
            self._measurement_delay,
            exact=not scenario.noise,
        )
        self._control = self._controller.start()
        self._nobody = np.zeros(len(scenarios), np.bool_)
        self._measurements = deque[Pose]()
        self._commands = deque([self._control.drive.speeds] * scenario.link.command_delay)
        self._tick = -1

    def answer(self, z: Pose) -> Answers:
        """At the next tick."""
        self._tick += 1
        if self._tick:
            self._control = self._controller.advance(self._control)
        self._measurements.append(z)
        there = self._tick >= self._measurement_delay
        arrived = self._measurements.popleft() if there else None
        control = self._control = self._controller.answer(self._control, arrived)
        sent = control.drive.speeds
        self._commands.append(sent)
        acts = self._nobody if control.found is None else control.found.acts
        return Answers(control.pose, control.P, sent, self._commands.popleft(), control.lost, acts)


class Impaired:
    """Over links that do more than delay."""

    def __init__(self, scenarios: Sequence[Scenario]) -> None:
        schedules = [schedule_of(each) for each in scenarios]
        delay = scenarios[0].link.measurement_delay
        timetable = Timetable([each.course for each in schedules], delay)
        config = station_config(scenarios[0])
        self._controller = ImpairedController(config, _starts(scenarios), timetable)
        self._beyond = np.array([each.beyond for each in schedules])

    def answer(self, z: Pose) -> Answers:
        """At the next tick."""
        pose, P, sent, lost = self._controller.answer(z)
        acts = self._beyond | self._controller.acts
        return Answers(pose, P, sent, self._controller.applied(), lost, acts)


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
        wheels = np.empty((2, len(turn)))
        np.subtract(speeds.v, turn, wheels[0])
        np.add(speeds.v, turn, wheels[1])
        wheels /= self._radius
        return wheels.T
