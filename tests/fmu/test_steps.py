"""Steps that cannot be: nowhere, beyond the end, into numbers that are none. Nothing moves."""

import math
from collections.abc import Callable
from ctypes import c_double
from typing import Any

import pytest

ERROR = 3
NAMES = ["Robot2", "Robot3"]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("step", [0.0, -0.01, math.nan, math.inf, 1e300])
def test_a_step_that_leads_nowhere(make_face: Callable[..., Any], name: str, step: float) -> None:
    face = make_face(name, "CoSimulation")
    face.start()
    before = face.get("x", "x_meas", "v")
    with face.refused(ERROR, "communicationStepSize"):
        face.step(0.0, step)
    assert face.get("x", "x_meas", "v") == before
    face.step(0.0)


@pytest.mark.parametrize("name", NAMES)
def test_a_step_too_small_for_the_time(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "CoSimulation")
    face.start(1e6)
    with face.refused(ERROR, "communicationStepSize 1e-11", "does not advance"):
        face.step(1e6, 1e-11)
    face.step(1e6, 1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_an_overflow_is_an_error_that_names_the_variable(
    make_face: Callable[..., Any], name: str
) -> None:
    face = make_face(name, "CoSimulation")
    face.start()
    face.step(0.0)
    before = face.get("x", "theta", "x_meas", "theta_meas")
    face.set(omega_left=-1e308, omega_right=1e308)
    with face.refused(ERROR, "omega of robot 0 is inf"):
        face.get("theta", "omega")
    for _ in range(2):
        with face.refused(ERROR, "of robot 0 is "):
            face.step(0.01)
    assert face.get("x", "theta", "x_meas", "theta_meas") == before
    face.set(omega_left=1.0, omega_right=1.0)
    face.step(0.01)
    assert all(map(math.isfinite, face.get("x", "y", "theta", "v", "omega")))


@pytest.mark.parametrize("name", NAMES)
def test_a_derivative_that_overflows_is_named(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "ModelExchange")
    face.start(theta_start=1.0, wheel_radius=10.0)
    face.fmu.enterContinuousTimeMode()
    face.set(omega_left=1e308, omega_right=1e308)
    values = (c_double * 3)()
    get = "getDerivatives" if name == "Robot2" else "getContinuousStateDerivatives"
    with face.refused(ERROR, "der(x) of robot 0 is inf"):
        getattr(face.fmu, get)(values, 3)
    with face.refused(ERROR, "der(y) of robot 0 is inf"):
        face.get("theta", "der(y)")


@pytest.mark.parametrize("name", NAMES)
def test_a_step_from_another_time(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "CoSimulation")
    face.start()
    face.step(0.0)
    for time in (0.0, 0.02, math.nan):
        with face.refused(ERROR, "currentCommunicationPoint" if time == time else "time nan"):
            face.step(time)
    face.step(0.01)


@pytest.mark.parametrize("name", NAMES)
def test_nothing_goes_beyond_the_stop_time(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "CoSimulation")
    with face.refused(ERROR, "startTime 2 s", "stopTime, 1 s"):
        face.start(2.0, stop=1.0)
    face.start(stop=0.3)
    for tick in range(30):  # 0.29 + 0.01 and 0.3 are not the same number
        face.step(tick * 0.01)
    before = face.get("x", "x_meas")
    with face.refused(ERROR, "0.31", "beyond stopTime, 0.29999"):
        face.step(0.3)
    assert face.get("x", "x_meas") == before
    other = make_face(name, "CoSimulation")
    other.become(face.packed())
    with other.refused(ERROR, "beyond stopTime"):
        other.step(0.3)
    face.fmu.reset()
    face.start()
    face.step(0.0, 1000.0)


@pytest.mark.parametrize("name", NAMES)
def test_model_exchange_takes_no_step_beyond_the_stop_time(
    make_face: Callable[..., Any], name: str
) -> None:
    """Its solver may look there."""
    face = make_face(name, "ModelExchange")
    face.start(stop=10.0)
    face.fmu.enterContinuousTimeMode()
    face.fmu.setTime(10.01)
    with face.refused(ERROR, "10.01", "is beyond stopTime, 10 s"):
        face.fmu.completedIntegratorStep()
    face.fmu.setTime(10.0)
    face.fmu.completedIntegratorStep()
