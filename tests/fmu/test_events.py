"""Co-simulation in event mode, with early return and intermediate update: the same robot."""

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.fmi1 import FMICallException

from laglab_fmu import Reading

OUTPUTS = Reading._fields
PARAMETERS = {"seed": 5, "motor_time_constant": 0.05}


class Watched:
    """A Robot3 in co-simulation whose intermediate values are written down."""

    def __init__(self, make_face: Callable[..., Any], **options: bool) -> None:
        self.options, self.seen, self.leave_at = options, [], float("inf")
        self.during: Callable[[], None] = lambda: None
        self.face = make_face("Robot3", "CoSimulation", intermediateUpdate=self._update, **options)
        self.face.start(**PARAMETERS)
        if options.get("eventModeUsed"):
            self.take_event()
        self.face.set(omega_left=3.0, omega_right=5.0)

    def _update(self, _: Any, time: float, *arguments: Any) -> None:
        *flags, early, early_time = arguments
        assert flags == [False, True, True, bool(self.options.get("earlyReturnAllowed"))]
        self.during()
        self.seen.append((time, self.face.get(*OUTPUTS)))
        if time >= self.leave_at:
            early[0], early_time[0] = True, time

    def take_event(self) -> float:
        """Through event mode and back; gives the time of the next event."""
        *_, defined, next_time = self.face.fmu.updateDiscreteStates()
        assert defined
        self.face.fmu.enterStepMode()
        return float(next_time)


def plain(make_face: Callable[..., Any], ticks: int) -> list[list[float]]:
    """What a robot says at each of its samples, stepped from one to the next."""
    face = make_face("Robot3", "CoSimulation")
    face.start(**PARAMETERS)
    face.set(omega_left=3.0, omega_right=5.0)
    readings = []
    for tick in range(ticks):
        face.step(tick * 0.01)
        readings.append(face.get(*OUTPUTS))
    return readings


def test_a_long_step_shows_each_sample_on_its_way(make_face: Callable[..., Any]) -> None:
    robot = Watched(make_face)
    assert robot.face.fmu.doStep(0.0, 0.1) == (False, False, False, 0.1)
    times, readings = zip(*robot.seen, strict=True)
    assert times == pytest.approx(np.arange(1, 11) / 100)
    assert list(readings) == plain(make_face, 10)


def test_nothing_but_reading_is_allowed_in_an_intermediate_update(
    make_face: Callable[..., Any],
) -> None:
    robot = Watched(make_face)
    fmu, refused = robot.face.fmu, []
    calls = (
        lambda: fmu.doStep(0.01, 0.01),
        lambda: robot.face.set(omega_left=1.0),
        fmu.getFMUState,
        fmu.reset,
        fmu.terminate,
    )

    def try_all() -> None:
        for call in calls:
            with pytest.raises(FMICallException):
                call()
            refused.append(robot.face.messages[-1][2])

    robot.during = try_all
    fmu.doStep(0.0, 0.01)
    assert len(refused) == len(calls)
    assert all("intermediate update mode" in line or "cannot be set" in line for line in refused)
    assert robot.face.get(*OUTPUTS) == plain(make_face, 1)[0]


def test_the_importer_leaves_a_step_early(make_face: Callable[..., Any]) -> None:
    robot = Watched(make_face, earlyReturnAllowed=True)
    robot.leave_at = 0.029
    *_, early, last = robot.face.fmu.doStep(0.0, 0.1)
    assert early
    assert last == robot.seen[-1][0] == robot.face.get("time")[0] == pytest.approx(0.03)
    robot.leave_at = float("inf")
    assert not robot.face.fmu.doStep(last, 0.1 - last)[2]
    assert [reading for _, reading in robot.seen] == plain(make_face, 10)


@pytest.mark.parametrize("early", [True, False])
def test_samples_are_taken_in_event_mode(make_face: Callable[..., Any], early: bool) -> None:
    """With early return at each of them; without, those inside a step by the step itself."""
    robot = Watched(make_face, eventModeUsed=True, earlyReturnAllowed=early)
    time, readings, ends = 0.0, [], []
    while time < 0.1 - 1e-9:
        event, _, returned_early, time = robot.face.fmu.doStep(time, 0.05 - time % 0.05)
        assert event
        assert returned_early == (abs(time % 0.05 - 0.05) > 1e-9 and time % 0.05 > 1e-9)
        before = robot.face.get("x", "x_meas")
        with pytest.raises(FMICallException):
            robot.face.step(time)
        assert "it is taken in event mode" in robot.face.messages[-1][2]
        robot.face.fmu.enterEventMode()
        next_time = robot.take_event()
        assert next_time == pytest.approx(time + 0.01)
        assert robot.face.get("x")[0] == before[0]
        assert robot.face.get("x_meas")[0] != before[1]
        ends.append(time)
        readings.append(robot.face.get(*OUTPUTS))
    assert ends == pytest.approx(np.arange(1, 11) / 100 if early else [0.05, 0.1])
    assert np.array(readings) == pytest.approx(
        np.array(plain(make_face, 10)[0 if early else 4 :: 1 if early else 5]), rel=1e-13
    )


def test_event_mode_without_an_event_changes_nothing(make_face: Callable[..., Any]) -> None:
    robot = Watched(make_face, eventModeUsed=True)
    assert not robot.face.fmu.doStep(0.0, 0.004)[0]
    before = robot.face.get(*OUTPUTS)
    robot.face.fmu.enterEventMode()
    assert robot.take_event() == pytest.approx(0.01)
    assert robot.face.get(*OUTPUTS) == before
    state = robot.face.packed()
    robot.face.fmu.enterEventMode()
    in_event_mode = robot.face.packed()
    other = make_face("Robot3", "CoSimulation")
    other.become(state)
    other.step(0.004, 0.006)
    with pytest.raises(FMICallException):
        other.become(in_event_mode)
    assert "in event mode" in other.messages[-1][2]


def test_event_mode_is_for_those_who_asked_for_it(make_face: Callable[..., Any]) -> None:
    face = make_face("Robot3", "CoSimulation")
    face.start()
    with pytest.raises(FMICallException):
        face.fmu.enterEventMode()
    assert "without event mode" in face.messages[-1][2]
    with pytest.raises(FMICallException):
        face.fmu.enterStepMode()


@pytest.mark.parametrize("name", ["Robot3", "Fleet3"])
@pytest.mark.parametrize("early", [True, False])
def test_fmpy_runs_event_mode_to_the_same_end(
    fmus: dict[str, Path], name: str, early: bool
) -> None:
    settings: dict[str, Any] = {"fmi_type": "CoSimulation", "stop_time": 0.5}
    settings |= {"output_interval": 0.02}
    if name != "Fleet3":
        settings["start_values"] = PARAMETERS
    reference = simulate_fmu(str(fmus[name]), **settings)
    result = simulate_fmu(
        str(fmus[name]), **settings, use_event_mode=True, early_return_allowed=early
    )
    last = np.append([b - a > 1e-9 for a, b in pairwise(result["time"])], True)
    at_outputs = np.isclose(result["time"] / 0.02, np.round(result["time"] / 0.02)) & last
    assert at_outputs.sum() == len(reference)
    for output in OUTPUTS:
        np.testing.assert_allclose(result[output][at_outputs], reference[output], rtol=1e-12)
