"""Bad input: the right status, one logged line that names it, and the instance goes on."""

import math
from collections.abc import Callable
from ctypes import byref, c_double, c_void_p
from typing import Any

import pytest
from fmpy.fmi1 import FMICallException

from laglab_fmu.models import ROBOT, Kind, Role

DISCARD, ERROR = 2, 3
NAMES = ["Robot2", "Robot3"]
KINDS = ["CoSimulation", "ModelExchange"]
SETTABLE = (Role.PARAMETER, Role.TUNABLE, Role.INPUT)


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
    for variable in ROBOT.variables:
        if variable.kind is Kind.FLOAT64 and variable.role in SETTABLE:
            with face.refused(DISCARD, f"{variable.name} = ", "refused"):
                face.set(**{variable.name: value})
    face.start()
    with face.refused(DISCARD, "omega_left = "):
        face.set(omega_left=value)
    still_works(face)


@pytest.mark.parametrize("name", NAMES)
def test_bounds_are_those_of_the_description(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "CoSimulation")
    for variable in ROBOT.variables:
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
            with face.refused(DISCARD, f"{variable.name} = "):
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
    with face.refused(DISCARD, parameter):
        setter([ROBOT.reference["wheel_radius"], ROBOT.reference[parameter]], [0.08, -1.0])
    assert face.get(parameter, "wheel_radius") == before


@pytest.mark.parametrize("name", NAMES)
def test_infinity_is_told_from_a_value_out_of_bounds(
    make_face: Callable[..., Any], name: str
) -> None:
    face = make_face(name, "CoSimulation")
    with face.refused(DISCARD, "omega_left = inf refused: it must be finite"):
        face.set(omega_left=math.inf)
    assert "in [" not in face.messages[-1][2]
    with face.refused(DISCARD, "track = 1000 refused: it must be in [0.001, 100]"):
        face.set(track=1000.0)
    face.start()
    with face.refused(ERROR, "communicationStepSize inf", "must be finite"):
        face.step(0.0, math.inf)


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
def test_calls_in_the_wrong_state(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "CoSimulation")
    with face.refused(ERROR, f"fmi{name[-1]}DoStep", "instantiated"):
        face.step(0.0)
    with face.refused(ERROR, "ExitInitializationMode"):
        face.fmu.exitInitializationMode()
    with face.refused(ERROR, "Terminate"):
        face.fmu.terminate()
    face.start()
    with face.refused(ERROR, "EnterInitializationMode", "step mode"):
        face.fmu.enterInitializationMode()
    with face.refused(ERROR, "track", "before the simulation starts"):
        face.set(track=1.0)
    still_works(face)
    face.fmu.terminate()
    with face.refused(ERROR, "DoStep", "terminated"):
        face.step(0.01)
    with face.refused(ERROR, "omega_left"):
        face.set(omega_left=1.0)
    face.fmu.reset()
    face.start()
    still_works(face)


@pytest.mark.parametrize("name", NAMES)
def test_model_exchange_calls_in_the_wrong_state(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "ModelExchange")
    states = (c_double * 3)(0.0, 0.0, 0.0)
    with face.refused(ERROR, "SetContinuousStates", "instantiated"):
        face.fmu.setContinuousStates(states, 3)
    face.start()
    with face.refused(ERROR, "CompletedIntegratorStep", "event mode"):
        face.fmu.completedIntegratorStep()
    face.fmu.enterContinuousTimeMode()
    with face.refused(ERROR, "3 continuous states"):
        face.fmu.setContinuousStates(states, 2)
    with face.refused(DISCARD, "state 1 (y) = nan"):
        face.fmu.setContinuousStates((c_double * 3)(0.0, math.nan, 0.0), 3)
    with face.refused(ERROR, "time nan"):
        face.fmu.setTime(math.nan)
    with face.refused(ERROR, "time -1", "before the start"):
        face.fmu.setTime(-1.0)
    still_works(face)


@pytest.mark.parametrize("name", NAMES)
def test_wrong_value_references(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "CoSimulation")
    real = "Real" if name == "Robot2" else "Float64"
    integer = "Integer" if name == "Robot2" else "Int32"
    for reference, word in (
        (len(ROBOT.variables), "unknown"),
        (2**32 - 1, "unknown"),
        (ROBOT.reference["seed"], "seed"),
    ):
        with face.refused(ERROR, str(reference), word):
            getattr(face.fmu, "get" + real)([ROBOT.reference["x"], reference])
        with face.refused(ERROR, str(reference), word):
            getattr(face.fmu, "set" + real)([reference], [1.0])
    with face.refused(ERROR, "(track)"):
        getattr(face.fmu, "get" + integer)([ROBOT.reference["track"]])
    with face.refused(ERROR, "(track)"):
        face.fmu.setBoolean([ROBOT.reference["track"]], [True])
    with face.refused(ERROR, "x cannot be set"):
        getattr(face.fmu, "set" + real)([ROBOT.reference["x"]], [1.0])
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
    with face.refused(DISCARD, "omega_left"):
        face.set(omega_left=math.nan)
    with face.refused(ERROR, "log category 0"):
        face.fmu.setDebugLogging(True, ["logNothing"])


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("kind", KINDS)
def test_a_wrong_token_makes_no_instance(
    make_face: Callable[..., Any], name: str, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    face = make_face(name, kind)
    monkeypatch.setattr(face.fmu, "guid", "{another}")
    component = face.fmu.component
    # FMPy's own logger for FMI 2 goes through what the last simulation in this process left
    own = {"callbacks": face.fmu.callbacks} if face.version == 2 else {}
    with pytest.raises(Exception, match="Failed to instantiate"):
        face.fmu.instantiate(**own)
    face.fmu.component = component
