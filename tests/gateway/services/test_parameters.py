"""Parameters are listed, read and set."""

import math

import pytest

from laglab_gateway import Services
from laglab_protocol import (
    Message,
    ParamError,
    ParamRequestList,
    ParamRequestRead,
    ParamSet,
    ParamValue,
)
from laglab_protocol.dialect.generated import laglab as mavlink

from .asking import GCS, REAL32, ask


def test_all_parameters_are_listed_in_order(services: Services) -> None:
    values = ask(services, ParamRequestList(1, 1))

    assert [each.param_id for each in values] == [  # type: ignore[attr-defined]
        b"DELAY_N",
        b"DELAY_M",
        b"V_MAX",
        b"OMEGA_MAX",
        b"LINK_TIMEOUT",
        b"LAW_GAMMA",
        b"TRIES",
    ]
    assert values[1] == ParamValue(20.0, 7, 1, b"DELAY_M", REAL32)


@pytest.mark.parametrize(("index", "name"), [(1, b""), (-1, b"DELAY_M"), (1, b"ignored")])
def test_one_parameter_is_read_by_index_or_name(
    services: Services, index: int, name: bytes
) -> None:
    assert ask(services, ParamRequestRead(index, 1, 1, name)) == [
        ParamValue(20.0, 7, 1, b"DELAY_M", REAL32)
    ]


def set_parameter(services: Services, name: bytes, value: float) -> list[Message]:
    return ask(services, ParamSet(value, 1, 1, name, REAL32))


def test_a_safe_parameter_is_set(services: Services) -> None:
    (answer,) = set_parameter(services, b"V_MAX", 0.5)

    assert answer == ParamValue(0.5, 7, 2, b"V_MAX", REAL32)
    assert services.parameters["V_MAX"] == 0.5


@pytest.mark.parametrize(
    ("name", "value", "error"),
    [
        (b"DELAY_N", 5.0, mavlink.MAV_PARAM_ERROR_READ_ONLY),
        (b"LAW_GAMMA", 5.0, mavlink.MAV_PARAM_ERROR_READ_ONLY),
        (b"V_MAX", -1.0, mavlink.MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE),
        (b"V_MAX", math.nan, mavlink.MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE),
        (b"V_MAX", math.inf, mavlink.MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE),
    ],
)
def test_a_refused_setting_says_why_and_what_holds(
    services: Services, name: bytes, value: float, error: int
) -> None:
    held = services.parameters[name.decode()]
    refusal, answer = set_parameter(services, name, value)

    assert refusal == ParamError(-1, *GCS, name, error)
    assert isinstance(answer, ParamValue)
    assert answer.param_value == held == services.parameters[name.decode()]


@pytest.mark.parametrize(
    "message",
    [
        ParamRequestRead(-1, 1, 1, b"NOTHING"),
        ParamRequestRead(7, 1, 1, b""),
        ParamRequestRead(-2, 1, 1, b""),
        ParamSet(1.0, 1, 1, b"\xff\xfe", REAL32),
    ],
)
def test_what_does_not_exist_is_said(services: Services, message: Message) -> None:
    (answer,) = ask(services, message)

    assert isinstance(answer, ParamError)
    assert answer.error == mavlink.MAV_PARAM_ERROR_DOES_NOT_EXIST
