"""What may be asked for, and what it says."""

import math
from collections.abc import Callable

import pytest

import laglab
from laglab_gateway import Origin, Services
from laglab_gateway.services import RobotState
from laglab_gateway.services.reports import REPORTS, Seen
from laglab_gateway.services.reports.frames import to_ned
from laglab_gateway.services.reports.identity import packed_version
from laglab_protocol import (
    AutopilotVersion,
    AutopilotVersionRequest,
    CommandAck,
    Heartbeat,
    Odometry,
    Receiver,
    Sender,
    SysStatus,
    message_type,
)
from laglab_protocol.dialect.generated import laglab as mavlink

from .asking import GCS, STATE, ask, command


@pytest.mark.parametrize("number", REPORTS)
def test_every_report_may_be_requested(services: Services, number: int) -> None:
    ack, report = ask(services, command(512, float(number)))

    assert ack == CommandAck(512, mavlink.MAV_RESULT_ACCEPTED, 0, 0, *GCS)
    assert type(report) is message_type(mavlink.mavlink_map[number].msgname)
    (sent,) = Receiver().receive(Sender(1, 1).frame(report))
    assert type(sent.message) is type(report)


def test_the_version_is_told_by_the_old_command_too(services: Services) -> None:
    _, version = ask(services, command(520, 1.0))

    assert isinstance(version, AutopilotVersion)
    assert version.capabilities & mavlink.MAV_PROTOCOL_CAPABILITY_MAVLINK2
    assert version.flight_sw_version == packed_version(laglab.__version__)


def test_the_version_is_told_by_the_message_of_old(services: Services) -> None:
    _, expected = ask(services, command(512, mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION))

    assert ask(services, AutopilotVersionRequest(1, 1)) == [expected]
    assert ask(services, AutopilotVersionRequest(2, 1)) == []


def test_the_fence_that_there_is_not_is_well(services: Services) -> None:
    _, status = ask(services, command(512, mavlink.MAVLINK_MSG_ID_SYS_STATUS))

    assert isinstance(status, SysStatus)
    fence = mavlink.MAV_SYS_STATUS_GEOFENCE
    assert status.onboard_control_sensors_health & fence
    assert not status.onboard_control_sensors_present & fence
    assert not status.onboard_control_sensors_enabled & fence


def test_odometry_is_in_frames_that_mean_the_world_and_the_body(services: Services) -> None:
    """MAV_FRAME_BODY_NED: of positions the local frame, of velocities the body's."""
    _, told = ask(services, command(512, mavlink.MAVLINK_MSG_ID_ODOMETRY))

    assert isinstance(told, Odometry)
    assert told.frame_id == told.child_frame_id == mavlink.MAV_FRAME_BODY_NED
    assert (told.x, told.y, told.vx, told.yawspeed) == (4.0, 3.0, 2.0, -0.5)


@pytest.mark.parametrize(
    ("text", "packed"),
    [
        ("0.1.0", 0x000100FF),
        ("1.2.3", 0x010203FF),
        ("1.2.3.post1", 0x010203FF),
        ("2.0", 0x020000FF),
        ("1.2.3a1", 0x01020340),
        ("1.2.3b1", 0x01020380),
        ("1.2rc1", 0x010200C0),
        ("1.2.3.dev4", 0x01020300),
        ("2024.1.0", 0xFF0100FF),
    ],
)
def test_versions_are_packed_as_the_message_has_them(text: str, packed: int) -> None:
    assert packed_version(text) == packed


@pytest.mark.parametrize(
    ("theta", "north", "east", "yaw"),
    [
        (0.0, 0.0, 2.0, math.pi / 2),  # along x: east
        (math.pi / 2, 2.0, 0.0, 0.0),  # along y: north
        (math.pi, 0.0, -2.0, -math.pi / 2),
        (-math.pi / 2, -2.0, 0.0, math.pi),
    ],
)
def test_frames_are_converted(theta: float, north: float, east: float, yaw: float) -> None:
    ned = to_ned(RobotState(0, 3.0, 4.0, theta, 2.0, 0.5))

    assert (ned.north, ned.east, ned.yaw_rate) == (4.0, 3.0, -0.5)
    assert (ned.v_north, ned.v_east) == pytest.approx((north, east), abs=1e-12)
    assert math.cos(ned.yaw - yaw) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("do", "armed", "status"),
    [
        (lambda _: None, False, mavlink.MAV_STATE_STANDBY),
        (lambda arming: arming.arm(), True, mavlink.MAV_STATE_ACTIVE),
        (lambda arming: arming.stop(), False, mavlink.MAV_STATE_EMERGENCY),
    ],
)
def test_the_heartbeat_says_whether_it_may_move(
    services: Services, do: Callable[[object], None], armed: bool, status: int
) -> None:
    do(services.arming)
    heartbeat = REPORTS[0](Seen(STATE, services.arming, Origin()))

    assert isinstance(heartbeat, Heartbeat)
    assert heartbeat.type == mavlink.MAV_TYPE_GROUND_ROVER
    assert bool(heartbeat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED) is armed
    assert heartbeat.system_status == status
