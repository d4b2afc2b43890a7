"""Runs that differ only in seed, start and link, all at once: the fleet FMU, many controllers.

The order of a tick is that of docs/tick.md, the numbers are those of the runs one by one. Where the
link does more than delay, what happens when is found out first, seed by seed (`schedule`).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.runs.robot_side import link_fates
from laglab.runs.station_side import station_config
from laglab.scenario import Scenario
from laglab.studies.many.schedule import schedule_of
from laglab_control import MEMORY
from laglab_control.batch import BATCHED, BatchController, Pose, Speeds, Symmetric
from laglab_control.batch.impaired import IMPAIRED, ImpairedController, Timetable
from laglab_fmu import CallError, OtherParameters
from laglab_gateway import Safety
from laglab_gateway.drive import FASTEST

if TYPE_CHECKING:
    from laglab_fmu import Fleet

Array = NDArray[np.float64]


class Ticks(NamedTuple):
    """Some ticks in a row of all runs; what comes next is written over them."""

    truth: Array
    """(3, ticks, robots) [m, m, rad]."""
    estimates: Array
    """The same; NaN where there is none."""
    P: Array
    """(6, ticks, robots), the upper triangle of what is claimed; NaN where nothing is."""
    applied: Array
    """(2, ticks, robots) [m/s, rad/s]."""
    ended: NDArray[np.bool_]
    """(ticks, robots): that run is over, and what is here does not count."""


OnTicks = Callable[[Ticks], object]


class Ends(NamedTuple):
    """What has become of the runs, (robots,) each."""

    last_tick: NDArray[np.int64]
    diverged: NDArray[np.bool_]
    """The run ended because the estimate did."""
    unsure: NDArray[np.bool_]
    """Something happened that a batch cannot express; run them one by one."""


def run_many(scenarios: Sequence[Scenario], told: OnTicks) -> Ends:
    """All of them to the end. There must be no reason to run them one by one (`why_one_by_one`)."""
    from laglab.runs.plant.fleet import fleet_parameters  # loads FMPy
    from laglab_fmu import Fleet

    parameters = [fleet_parameters(each) for each in scenarios]
    with Fleet.open(parameters) as fleet, np.errstate(all="ignore"):  # what diverges overflows
        way = OnTime(scenarios) if is_ideal(scenarios[0]) else Impaired(scenarios)
        return _run(fleet, scenarios[0], way.answer, told)


def why_one_by_one(scenario: Scenario) -> str | None:
    """Why a run of that scenario cannot be one of many; None when it can."""
    link, kind = scenario.link, scenario.estimator.kind
    reasons = {
        f"there is no {kind} for many robots": kind not in BATCHED,
        f"there is no {kind} for many robots on such a link": (
            kind not in IMPAIRED and not is_ideal(scenario)
        ),
        f"there is no law {scenario.law.kind} for many robots": scenario.law.kind != "polar",
        f"of {scenario.plant.called} there is one a run, and no fleet (plant)": (
            not scenario.plant.ships
        ),
        "one of its parameters is set for each by itself (plant.parameters)": not _are_common(
            scenario
        ),
        f"a delay is no shorter than the {MEMORY} ticks for which a station remembers (link)": (
            max(link.n, link.m) >= MEMORY
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


def _are_common(scenario: Scenario) -> bool:
    """Whether the plant's parameters are among those that a fleet is told, as it is told them."""
    plant = scenario.plant
    if not (plant.ships and plant.parameters):
        return True
    sample_time = plant.parameters.get("sample_time", scenario.sample_time)
    return sample_time == scenario.sample_time and _is_told(plant.model, plant.parameters)


def _is_told(model: str, named: Mapping[str, object]) -> bool:
    """Whether a fleet of that robot can be told them; which values it takes it says itself."""
    try:
        OtherParameters(model, named).by_name()
    except CallError:
        return False
    return True


def is_ideal(scenario: Scenario) -> bool:
    """Whether the link delivers everything on time, and the robot never has to stop by itself."""
    return not link_fates(scenario) and scenario.safety.link_timeout > 0


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


def _run(
    fleet: Fleet, scenario: Scenario, answer: Callable[[Pose], Answers], told: OnTicks
) -> Ends:
    """`answer` is given what is sampled at each tick."""
    last, robots = scenario.must_end(), len(fleet.readings)
    inputs = body_speeds if scenario.plant.is_mapped else Wheels(scenario).turning
    page = Page(robots)
    last_tick = np.full(robots, last)
    diverged, unsure = np.zeros(robots, np.bool_), np.zeros(robots, np.bool_)
    for k in range(last + 1):
        answers = answer(Pose(*fleet.readings[:, 3:6].T.copy()))
        page.write(fleet.readings[:, :3].T, answers, diverged)
        unsure |= ~diverged & (answers.acts | refused(answers.sent, scenario.safety))
        if answers.lost.any():
            last_tick[answers.lost & ~diverged] = k
            diverged |= answers.lost
        if page.is_full or k == last:
            told(page.take())
        if k < last:
            fleet.step(inputs(answers.applied))
    return Ends(last_tick, diverged, unsure)


PAGE = 8
"""Ticks."""


class Page:
    """Where ticks are written until it is full, and then again: fresh memory for each would take as
    long as half of what a filter does in it."""

    def __init__(self, robots: int) -> None:
        truth, estimates, P, applied = (np.empty((each, PAGE, robots)) for each in (3, 3, 6, 2))
        self._ticks = Ticks(truth, estimates, P, applied, np.empty((PAGE, robots), np.bool_))
        self._filled = 0

    @property
    def is_full(self) -> bool:
        """Whether it must be taken before the next tick."""
        return self._filled == PAGE

    def write(self, truth: Array, answers: Answers, ended: NDArray[np.bool_]) -> None:
        """A tick; `truth` is (3, robots)."""
        ticks, k = self._ticks, self._filled
        ticks.truth[:, k] = truth
        if answers.pose is None or answers.P is None:  # as the station reports it
            ticks.estimates[:, k], ticks.P[:, k] = np.nan, np.nan
        else:
            _keep(ticks.estimates, k, answers.pose)
            _keep(ticks.P, k, answers.P)
        _keep(ticks.applied, k, answers.applied)
        ticks.ended[k] = ended
        self._filled += 1

    def take(self) -> Ticks:
        """All that is written; it is empty then."""
        filled, self._filled = self._filled, 0
        truth, estimates, P, applied = (each[:, :filled] for each in self._ticks[:4])
        return Ticks(truth, estimates, P, applied, self._ticks.ended[:filled])


def _keep(rows: Array, k: int, values: Iterable[Array]) -> None:
    for row, each in zip(rows, values, strict=True):
        row[k] = each


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


def body_speeds(speeds: Speeds) -> Array:
    """(robots, 2) [m/s, rad/s], column-major as the FMU reads them."""
    return np.array([speeds.v, speeds.omega]).T


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
