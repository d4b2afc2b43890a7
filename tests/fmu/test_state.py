"""Saving, restoring and serializing states: the noise comes back with them."""

import struct
from collections.abc import Callable
from typing import Any

import pytest
from fmpy.fmi1 import FMICallException
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

OUTPUTS = ("x", "y", "theta", "x_meas", "y_meas", "theta_meas", "v", "omega")
CHECKSUM = 8
HEAD = 56


def drive(face: Any, first: int, ticks: int) -> list[list[float]]:
    """Steps a co-simulation face and reads everything at each tick."""
    readings = []
    for tick in range(first, first + ticks):
        face.set(omega_left=1.0 + tick % 3, omega_right=2.0)
        face.step(tick * 0.01)
        readings.append(face.get(*OUTPUTS))
    return readings


@pytest.mark.parametrize("name", ["Robot2", "Robot3"])
def test_restoring_repeats_the_run_and_its_noise(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "CoSimulation")
    face.start(seed=9, integration=2)
    drive(face, 0, 30)
    state = face.save()
    first = drive(face, 30, 20)
    face.restore(state)
    assert drive(face, 30, 20) == first
    face.free(state)


@pytest.mark.parametrize("name", ["Robot2", "Robot3"])
def test_a_serialized_state_goes_on_in_another_instance(
    make_face: Callable[..., Any], name: str
) -> None:
    face, other = make_face(name, "CoSimulation"), make_face(name, "CoSimulation")
    face.start(seed=9, x_start=-3.0)
    drive(face, 0, 30)
    other.become(face.packed())
    assert drive(other, 30, 20) == drive(face, 30, 20)


def test_the_serialized_state_is_the_same_in_both_versions(make_face: Callable[..., Any]) -> None:
    serialized = []
    for name in ("Robot2", "Robot3"):
        face = make_face(name, "CoSimulation")
        face.start(seed=4)
        drive(face, 0, 5)
        serialized.append(face.packed())
    assert serialized[0] == serialized[1]


@pytest.mark.parametrize("name", ["Robot2", "Robot3"])
def test_a_state_of_the_other_kind_is_refused(make_face: Callable[..., Any], name: str) -> None:
    stepped, integrated = make_face(name, "CoSimulation"), make_face(name, "ModelExchange")
    stepped.start()
    integrated.start()
    state = stepped.save()
    with pytest.raises(FMICallException):
        integrated.restore(state)
    assert "co-simulation" in integrated.messages[-1][2]
    stepped.free(state)


@pytest.mark.parametrize("name", ["Robot2", "Robot3"])
def test_time_comes_back_in_model_exchange(make_face: Callable[..., Any], name: str) -> None:
    face, other = make_face(name, "ModelExchange"), make_face(name, "ModelExchange")
    face.start(time=5.0, seed=8)
    other.start(time=1.0)
    other.become(face.packed())
    fmu = other.fmu
    *_, next_time = fmu.newDiscreteStates() if name == "Robot2" else fmu.updateDiscreteStates()
    assert next_time == pytest.approx(5.01)
    assert other.get("x_meas", "v") == face.get("x_meas", "v")


def checksum(data: bytes, token: str) -> int:
    """FNV-1a of the token with its final zero, then of all but the checksum."""
    total = 0xCBF29CE484222325
    for byte in token.encode() + b"\0" + data[CHECKSUM:]:
        total = (total ^ byte) * 0x100000001B3 % 2**64
    return total


@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_damaged_states_are_refused_or_harmless(
    make_face: Callable[..., Any], data: st.DataObject
) -> None:
    """Bytes changed, cut or added; with the checksum left wrong, or made to fit again."""
    from laglab_fmu.models import token

    face = make_face("Robot3", "CoSimulation")
    face.start(seed=2)
    before = drive(face, 0, 2)[-1]
    state = face.save()
    sound = face.serialize(state)
    face.free(state)
    damaged = bytearray(sound)
    for _ in range(data.draw(st.integers(1, 4))):
        word = data.draw(st.integers(0, len(sound) // 8 - 1)) * 8
        damaged[word : word + 8] = data.draw(st.binary(min_size=8, max_size=8))
    damaged = damaged[: data.draw(st.integers(0, len(sound)))] + data.draw(st.binary(max_size=9))
    fits = data.draw(st.booleans())
    if fits and len(damaged) > CHECKSUM:
        struct.pack_into("<Q", damaged, 0, checksum(bytes(damaged), token("Robot3")))
    try:
        received = face.deserialize(bytes(damaged))
    except FMICallException:
        assert face.messages[-1][:2] == (3, "logStatusError")
        assert len(face.messages) == 1
    else:
        assert fits or bytes(damaged) == sound
        face.free(received)
    assert face.get(*OUTPUTS) == before
    drive(face, 2, 3)


@pytest.mark.parametrize(
    ("offset", "value", "what"),
    [
        (HEAD + 15 * 8, struct.pack("<d", 0.0), "sample_time"),
        (HEAD + 1 * 8, struct.pack("<d", float("nan")), "track"),
        (HEAD + 7 * 8, struct.pack("<d", -1.0), "wheel_noise_variance"),
        (HEAD + 32 * 8, struct.pack("<d", -1.0), "elapsed"),
        (HEAD + 32 * 8, struct.pack("<d", 1e300), "elapsed"),
        (HEAD + 33 * 8, struct.pack("<q", -1), "sample"),
        (HEAD + 33 * 8, struct.pack("<q", 2**62), "sample"),
        (16, struct.pack("<Q", 7), "kind"),
        (24, struct.pack("<Q", 3), "mode"),
    ],
)
def test_impossible_values_are_named(
    make_face: Callable[..., Any], offset: int, value: bytes, what: str
) -> None:
    from laglab_fmu.models import token

    face = make_face("Robot2", "CoSimulation")
    face.start()
    state = face.save()
    data = bytearray(face.serialize(state))
    face.free(state)
    data[offset : offset + 8] = value
    struct.pack_into("<Q", data, 0, checksum(bytes(data), token("Robot3")))
    with pytest.raises(FMICallException):
        face.deserialize(bytes(data))
    assert what in face.messages[-1][2]
