"""Bad input: the right status, one logged line that names it, and the instance goes on."""

import math
from collections.abc import Callable
from ctypes import byref, c_double, c_void_p
from typing import Any

import pytest
from fmpy.fmi1 import FMICallException

from laglab_fmu.variables import REFERENCE, VARIABLES, Kind, Role

DISCARD, ERROR = 2, 3
NAMES = ["Robot2", "Robot3"]
KINDS = ["CoSimulation", "ModelExchange"]
SETTABLE = (Role.PARAMETER, Role.TUNABLE, Role.INPUT)
CATEGORY = {DISCARD: "logStatusDiscard", ERROR: "logStatusError"}


def refused(face: Any, status: int, *words: str) -> Any:
    """Expects a call to fail with this status and to log one line with these words."""

    class Refused:
        def __enter__(self) -> None:
            face.messages.clear()

        def __exit__(self, kind: type[BaseException] | None, error: Any, _trace: Any) -> bool:
            assert kind is FMICallException
            assert error.status == status
            assert len(face.messages) == 1
            assert face.messages[0][:2] == (status, CATEGORY[status])
            line = face.messages[0][2]
            assert "\n" not in line
            assert all(word in line for word in words), line
            return True

    return Refused()


def still_works(face: Any) -> None:
    """Finishes initialization where needed, and moves or differentiates."""
    if face.kind == "CoSimulation":
        face.step(0.0)
    assert all(map(math.isfinite, face.get("x", "y", "theta", "v", "omega")))


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_every_real_must_be_finite(
    make_face: Callable[..., Any], name: str, kind: str, value: float
) -> None:
    face = make_face(name, kind)
    for variable in VARIABLES:
        if variable.kind is Kind.FLOAT64 and variable.role in SETTABLE:
            with refused(face, DISCARD, f"{variable.name} = ", "refused"):
                face.set(**{variable.name: value})
    face.start()
    with refused(face, DISCARD, "omega_left = "):
        face.set(omega_left=value)
    still_works(face)


@pytest.mark.parametrize("name", NAMES)
def test_bounds_are_those_of_the_description(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "CoSimulation")
    for variable in VARIABLES:
        if variable.role not in SETTABLE or variable.kind is Kind.BOOLEAN:
            continue
        for bound, direction in ((variable.minimum, -1), (variable.maximum, 1)):
            if bound is None:
                continue
            if variable.kind is Kind.FLOAT64:
                face.set(**{variable.name: bound})
                beyond = math.nextafter(bound, direction * math.inf)
            elif abs(bound + direction) < 2**31:
                beyond = int(bound) + direction
            else:
                continue
            with refused(face, DISCARD, f"{variable.name} = "):
                face.set(**{variable.name: beyond})
    face.fmu.reset()
    face.start()
    still_works(face)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("parameter", ["track", "wheel_noise_variance", "sample_time"])
def test_a_refused_value_changes_nothing(
    make_face: Callable[..., Any], name: str, parameter: str
) -> None:
    face = make_face(name, "CoSimulation")
    face.set(wheel_radius=0.07)
    before = face.get(parameter, "wheel_radius")
    setter = face.fmu.setReal if face.version == 2 else face.fmu.setFloat64
    with refused(face, DISCARD, parameter):
        setter([REFERENCE["wheel_radius"], REFERENCE[parameter]], [0.08, -1.0])
    assert face.get(parameter, "wheel_radius") == before


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("step", [0.0, -0.01, math.nan, math.inf, 1e300])
def test_a_step_that_leads_nowhere(make_face: Callable[..., Any], name: str, step: float) -> None:
    face = make_face(name, "CoSimulation")
    face.start()
    before = face.get("x", "x_meas", "v")
    with refused(face, ERROR, "communicationStepSize"):
        face.step(0.0, step)
    assert face.get("x", "x_meas", "v") == before
    still_works(face)


@pytest.mark.parametrize("name", NAMES)
def test_infinity_is_told_from_a_value_out_of_bounds(
    make_face: Callable[..., Any], name: str
) -> None:
    face = make_face(name, "CoSimulation")
    with refused(face, DISCARD, "omega_left = inf refused: it must be finite"):
        face.set(omega_left=math.inf)
    assert "in [" not in face.messages[-1][2]
    with refused(face, DISCARD, "track = 1000 refused: it must be in [0.001, 100]"):
        face.set(track=1000.0)
    face.start()
    with refused(face, ERROR, "communicationStepSize inf", "must be finite"):
        face.step(0.0, math.inf)


@pytest.mark.parametrize("name", NAMES)
def test_a_step_too_small_for_the_time(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "CoSimulation")
    face.start(1e6)
    with refused(face, ERROR, "communicationStepSize 1e-11", "does not advance"):
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
    with refused(face, ERROR, "omega of robot 0 is inf"):
        face.get("theta", "omega")
    for _ in range(2):
        with refused(face, ERROR, "of robot 0 is "):
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
    with refused(face, ERROR, "der(x) of robot 0 is inf"):
        getattr(face.fmu, get)(values, 3)
    with refused(face, ERROR, "der(y) of robot 0 is inf"):
        face.get("theta", "der(y)")


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("kind", KINDS)
def test_an_unknown_type_makes_no_instance(
    make_face: Callable[..., Any], name: str, kind: str
) -> None:
    """FMI 2.0 tells the type by a number; 3.0 by the function, and one of those is not offered."""
    face = make_face(name, kind)
    text = (face.fmu.instanceName.encode(), face.fmu.guid.encode(), b"")
    if name == "Robot2":
        given = face.fmu.fmi2Instantiate(text[0], 2, *text[1:], byref(face.fmu.callbacks), 0, 0)
        assert "type 2 is neither" in face.messages[-1][2]
    else:
        instantiate = face.fmu.dll["fmi3InstantiateScheduledExecution"]
        instantiate.restype = c_void_p
        given = instantiate(*text, False, False, None, face.fmu.logMessage, None, None, None)
        assert "scheduled execution" in face.messages[-1][2]
    assert not given


@pytest.mark.parametrize("name", NAMES)
def test_a_step_from_another_time(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "CoSimulation")
    face.start()
    face.step(0.0)
    for time in (0.0, 0.02, math.nan):
        with refused(face, ERROR, "currentCommunicationPoint" if time == time else "time nan"):
            face.step(time)
    face.step(0.01)


@pytest.mark.parametrize("name", NAMES)
def test_nothing_goes_beyond_the_stop_time(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "CoSimulation")
    with refused(face, ERROR, "startTime 2 s", "stopTime, 1 s"):
        face.start(2.0, stop=1.0)
    face.start(stop=0.3)
    for tick in range(30):  # 0.29 + 0.01 and 0.3 are not the same number
        face.step(tick * 0.01)
    before = face.get("x", "x_meas")
    with refused(face, ERROR, "0.31", "beyond stopTime, 0.29999"):
        face.step(0.3)
    assert face.get("x", "x_meas") == before
    other = make_face(name, "CoSimulation")
    other.become(face.packed())
    with refused(other, ERROR, "beyond stopTime"):
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
    with refused(face, ERROR, "10.01", "is beyond stopTime, 10 s"):
        face.fmu.completedIntegratorStep()
    face.fmu.setTime(10.0)
    face.fmu.completedIntegratorStep()


@pytest.mark.parametrize("name", NAMES)
def test_calls_in_the_wrong_state(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "CoSimulation")
    with refused(face, ERROR, f"fmi{name[-1]}DoStep", "instantiated"):
        face.step(0.0)
    with refused(face, ERROR, "ExitInitializationMode"):
        face.fmu.exitInitializationMode()
    with refused(face, ERROR, "Terminate"):
        face.fmu.terminate()
    face.start()
    with refused(face, ERROR, "EnterInitializationMode", "step mode"):
        face.fmu.enterInitializationMode()
    with refused(face, ERROR, "track", "before the simulation starts"):
        face.set(track=1.0)
    still_works(face)
    face.fmu.terminate()
    with refused(face, ERROR, "DoStep", "terminated"):
        face.step(0.01)
    with refused(face, ERROR, "omega_left"):
        face.set(omega_left=1.0)
    face.fmu.reset()
    face.start()
    still_works(face)


@pytest.mark.parametrize("name", NAMES)
def test_model_exchange_calls_in_the_wrong_state(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "ModelExchange")
    states = (c_double * 3)(0.0, 0.0, 0.0)
    with refused(face, ERROR, "SetContinuousStates", "instantiated"):
        face.fmu.setContinuousStates(states, 3)
    face.start()
    with refused(face, ERROR, "CompletedIntegratorStep", "event mode"):
        face.fmu.completedIntegratorStep()
    face.fmu.enterContinuousTimeMode()
    with refused(face, ERROR, "3 continuous states"):
        face.fmu.setContinuousStates(states, 2)
    with refused(face, DISCARD, "state 1 (y) = nan"):
        face.fmu.setContinuousStates((c_double * 3)(0.0, math.nan, 0.0), 3)
    with refused(face, ERROR, "time nan"):
        face.fmu.setTime(math.nan)
    with refused(face, ERROR, "time -1", "before the start"):
        face.fmu.setTime(-1.0)
    still_works(face)


@pytest.mark.parametrize("name", NAMES)
def test_wrong_value_references(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "CoSimulation")
    real = "Real" if name == "Robot2" else "Float64"
    integer = "Integer" if name == "Robot2" else "Int32"
    for reference, word in (
        (len(VARIABLES), "unknown"),
        (2**32 - 1, "unknown"),
        (REFERENCE["seed"], "seed"),
    ):
        with refused(face, ERROR, str(reference), word):
            getattr(face.fmu, "get" + real)([REFERENCE["x"], reference])
        with refused(face, ERROR, str(reference), word):
            getattr(face.fmu, "set" + real)([reference], [1.0])
    with refused(face, ERROR, "(track)"):
        getattr(face.fmu, "get" + integer)([REFERENCE["track"]])
    with refused(face, ERROR, "(track)"):
        face.fmu.setBoolean([REFERENCE["track"]], [True])
    with refused(face, ERROR, "x cannot be set"):
        getattr(face.fmu, "set" + real)([REFERENCE["x"]], [1.0])
    face.start()
    still_works(face)


@pytest.mark.parametrize("name", NAMES)
def test_the_log_can_be_chosen_by_category(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "CoSimulation", debug=True)
    face.start()
    assert face.messages == [(0, "logEvents", "initializing 1 robot(s) at time 0 s")]
    face.messages.clear()
    face.fmu.setDebugLogging(False, ["logStatusDiscard", "logEvents"])
    with pytest.raises(FMICallException):
        face.set(omega_left=math.nan)
    assert face.messages == []
    face.fmu.setDebugLogging(True, [])
    with refused(face, DISCARD, "omega_left"):
        face.set(omega_left=math.nan)
    with refused(face, ERROR, "log category 0"):
        face.fmu.setDebugLogging(True, ["logNothing"])


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("kind", KINDS)
def test_a_wrong_token_makes_no_instance(
    make_face: Callable[..., Any], name: str, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    face = make_face(name, kind)
    monkeypatch.setattr(face.fmu, "guid", "{another}")
    component = face.fmu.component
    with pytest.raises(Exception, match="Failed to instantiate"):
        face.fmu.instantiate()
    face.fmu.component = component
