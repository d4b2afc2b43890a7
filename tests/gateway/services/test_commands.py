"""Every command that is meant for the robot is acknowledged."""

import math

import pytest

from laglab_gateway import Services
from laglab_protocol import (
    Command,
    CommandAck,
    CommandInt,
    Heartbeat,
    ParamRequestList,
    SetMode,
)
from laglab_protocol.dialect.generated import laglab as mavlink

from .asking import ARM, GCS, RESET, STOP, ask, command, result

DO_SET_MODE, ARMED = mavlink.MAV_CMD_DO_SET_MODE, mavlink.MAV_MODE_FLAG_SAFETY_ARMED


def test_arming_and_disarming(services: Services) -> None:
    assert result(services, ARM, 1.0) == mavlink.MAV_RESULT_ACCEPTED
    assert services.arming.armed
    assert result(services, ARM, 0.0) == mavlink.MAV_RESULT_ACCEPTED
    assert not services.arming.armed


def test_an_emergency_stop_latches_until_the_pose_is_reset(services: Services) -> None:
    services.arming.arm()
    assert result(services, STOP, 1.0) == mavlink.MAV_RESULT_ACCEPTED
    assert not services.arming.armed
    assert result(services, ARM, 1.0) == mavlink.MAV_RESULT_TEMPORARILY_REJECTED
    assert result(services, RESET, 1.0, 2.0, math.nan) == mavlink.MAV_RESULT_ACCEPTED

    x, y, theta = services.arming.take_reset() or (0, 0, 0)
    assert (x, y) == (1.0, 2.0)
    assert math.isnan(theta)
    assert services.arming.take_reset() is None
    assert result(services, ARM, 1.0) == mavlink.MAV_RESULT_ACCEPTED


def test_the_pose_is_not_reset_under_way(services: Services) -> None:
    services.arming.arm()

    assert result(services, RESET, 0.0, 0.0, 0.0) == mavlink.MAV_RESULT_TEMPORARILY_REJECTED
    assert services.arming.take_reset() is None


@pytest.mark.parametrize(
    ("number", "numbers", "expected"),
    [
        (ARM, (2.0,), mavlink.MAV_RESULT_DENIED),
        (ARM, (math.nan,), mavlink.MAV_RESULT_DENIED),
        (STOP, (0.0,), mavlink.MAV_RESULT_DENIED),
        (RESET, (math.inf, 0.0, 0.0), mavlink.MAV_RESULT_DENIED),
        (512, (147.0,), mavlink.MAV_RESULT_UNSUPPORTED),
        (512, (math.nan,), mavlink.MAV_RESULT_UNSUPPORTED),
        (511, (32.0, math.nan), mavlink.MAV_RESULT_DENIED),
        (511, (147.0, 1e6), mavlink.MAV_RESULT_UNSUPPORTED),
        (22, (), mavlink.MAV_RESULT_UNSUPPORTED),
        (65535, (), mavlink.MAV_RESULT_UNSUPPORTED),
    ],
)
def test_every_command_is_acknowledged(
    services: Services, number: int, numbers: tuple[float, ...], expected: int
) -> None:
    assert result(services, number, *numbers) == expected


@pytest.mark.parametrize(
    ("number", "expected"),
    [(ARM, mavlink.MAV_RESULT_ACCEPTED), (22, mavlink.MAV_RESULT_UNSUPPORTED)],
)
def test_command_int_is_acknowledged_too(services: Services, number: int, expected: int) -> None:
    (ack,) = ask(services, CommandInt(1.0, 0.0, 0.0, 0.0, 0, 0, 0.0, number, 1, 1, 0, 0, 0))

    assert ack == CommandAck(number, expected, 0, 0, *GCS)


GUIDED = mavlink.MAV_MODE_FLAG_GUIDED_ENABLED


@pytest.mark.parametrize(
    ("base_mode", "custom_mode", "there_is"),
    [
        (GUIDED, 0, True),
        (GUIDED | mavlink.MAV_MODE_FLAG_SAFETY_ARMED, 0, True),
        (0, 0, False),
        (mavlink.MAV_MODE_MANUAL_DISARMED, 0, False),
        (mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, 15, False),
        (GUIDED, 15, False),
    ],
)
def test_a_mode_is_accepted_if_heartbeats_then_show_it(
    services: Services, base_mode: int, custom_mode: int, there_is: bool
) -> None:
    expected = mavlink.MAV_RESULT_ACCEPTED if there_is else mavlink.MAV_RESULT_DENIED
    assert result(services, DO_SET_MODE, base_mode, custom_mode) == expected
    assert ask(services, SetMode(custom_mode, 1, base_mode)) == [
        CommandAck(DO_SET_MODE, expected, 0, 0, *GCS)
    ]
    _, shown = ask(services, command(512, 0.0))
    assert isinstance(shown, Heartbeat)
    assert ((shown.base_mode, shown.custom_mode) == (base_mode & ~ARMED, custom_mode)) is there_is
    assert not services.arming.armed, "the mode arms nothing"


@pytest.mark.parametrize("number", [math.nan, math.inf, -1.0, 8.5])
def test_what_is_no_mode_is_denied(services: Services, number: float) -> None:
    assert result(services, DO_SET_MODE, number) == mavlink.MAV_RESULT_DENIED
    assert result(services, DO_SET_MODE, GUIDED, number) == mavlink.MAV_RESULT_DENIED


def test_a_mode_for_another_system_is_passed_over(services: Services) -> None:
    assert ask(services, SetMode(0, 2, GUIDED)) == []


@pytest.mark.parametrize("target", [(2, 1), (1, 2), (200, 190)])
def test_what_is_meant_for_others_is_passed_over(
    services: Services, target: tuple[int, int]
) -> None:
    assert ask(services, command(ARM, 1.0, target=target)) == []
    assert ask(services, ParamRequestList(*target)) == []
    assert not services.arming.armed


def test_a_command_of_motion_is_no_service(services: Services) -> None:
    services.arming.arm()

    assert ask(services, Command(1.0, 1.0, 0, 1, 1, 0)) == []
