"""The rover's services, told frame by frame: no socket, no clock."""

import itertools
import math
from collections.abc import Callable, Iterable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import laglab
from laglab_gateway import Safety
from laglab_gateway.services import (
    Asker,
    Askers,
    Pace,
    Parameter,
    RobotState,
    Services,
    Timesyncing,
    standard_parameters,
)
from laglab_gateway.services.telemetry import REPORTS, packed_version, to_ned
from laglab_protocol import (
    AutopilotVersion,
    Command,
    CommandAck,
    CommandInt,
    CommandLong,
    Frame,
    Heartbeat,
    Message,
    ParamError,
    ParamRequestList,
    ParamRequestRead,
    ParamSet,
    ParamValue,
    Ping,
    Receiver,
    Sender,
    Timesync,
    message_type,
)
from laglab_protocol.dialect.generated import laglab as mavlink

STATE = RobotState(1_500_000, 3.0, 4.0, 0.0, 2.0, 0.5)
GCS = (255, 190)
REAL32 = mavlink.MAV_PARAM_TYPE_REAL32


@pytest.fixture
def services() -> Services:
    others = [Parameter("LAW_GAMMA", 3.0), Parameter("TRIES", 2, True, 1, 9, whole=True)]
    return Services(standard_parameters(10, 20, Safety(), others), armed=False)


def frame(message: Message, sender: tuple[int, int] = GCS) -> Frame:
    return Frame(message, *sender, 0, b"")


def ask(services: Services, message: Message) -> list[Message]:
    return services.answer(frame(message), STATE)


def command(number: int, *numbers: float, target: tuple[int, int] = (1, 1)) -> CommandLong:
    padded = (*numbers, *[0.0] * (7 - len(numbers)))
    return CommandLong(*padded, number, *target, 0)


def result(services: Services, number: int, *numbers: float) -> int:
    ack, *_ = ask(services, command(number, *numbers))
    assert isinstance(ack, CommandAck)
    assert (ack.command, ack.target_system, ack.target_component) == (number, *GCS)
    return ack.result


ARM, STOP, RESET = 400, 185, mavlink.MAV_CMD_LAGLAB_RESET_POSE


# Parameters


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
        (b"TRIES", 2.5, mavlink.MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE),
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


# Commands


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
        (512, (24.0,), mavlink.MAV_RESULT_UNSUPPORTED),
        (512, (math.nan,), mavlink.MAV_RESULT_UNSUPPORTED),
        (511, (32.0, math.nan), mavlink.MAV_RESULT_DENIED),
        (511, (24.0, 1e6), mavlink.MAV_RESULT_UNSUPPORTED),
        (22, (), mavlink.MAV_RESULT_UNSUPPORTED),
        (65535, (), mavlink.MAV_RESULT_UNSUPPORTED),
    ],
)
def test_every_command_is_acknowledged(
    services: Services, number: int, numbers: tuple[float, ...], expected: int
) -> None:
    assert result(services, number, *numbers) == expected


def test_command_int_is_acknowledged_too(services: Services) -> None:
    (ack,) = ask(services, CommandInt(1.0, 0.0, 0.0, 0.0, 0, 0, 0.0, ARM, 1, 1, 0, 0, 0))

    assert isinstance(ack, CommandAck)
    assert ack.result == mavlink.MAV_RESULT_ACCEPTED


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


# Ping and time


def test_a_ping_is_answered_and_an_answer_is_not(services: Services) -> None:
    assert ask(services, Ping(7, 8, 0, 0)) == [Ping(7, 8, *GCS)]
    assert ask(services, Ping(7, 8, 1, 1)) == []


def test_in_simulated_time_clocks_are_not_compared(services: Services) -> None:
    assert ask(services, Timesync(0, 123)) == []


def test_a_question_of_time_is_answered() -> None:
    services = Services(standard_parameters(0, 0, Safety()), timesync=Timesyncing(lambda: 1000))

    assert ask(services, Timesync(0, 123)) == [Timesync(1000, 123)]


@given(st.integers(-(10**15), 10**15), st.integers(0, 10**9), st.integers(0, 10**9))
def test_offset_and_round_trip(offset: int, there: int, back: int) -> None:
    """A peer whose clock is ahead, at the end of a line of equal delays, is measured exactly."""
    start = 5 * 10**15
    times = iter([start, start + there + back])
    ours = Timesyncing(lambda: next(times))
    question = ours.ask()
    (answer,) = Timesyncing(lambda: start + there + offset).answer(question)
    assert isinstance(answer, Timesync)
    ours.answer(answer)

    found = ours.report()
    assert found is not None
    assert found.samples == 1
    assert found.round_trip_p50_s == pytest.approx((there + back) * 1e-9, rel=1e-3, abs=1.1e-9)
    assert abs(found.offset_s * 1e9 - offset) <= abs(there - back) / 2 + 2


def test_an_answer_to_another_question_is_no_sample() -> None:
    times = itertools.count(1000)
    ours = Timesyncing(lambda: next(times))
    ours.ask()
    ours.answer(Timesync(5, 77))

    assert ours.report() is None


# Telemetry


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


def reports(pace: Pace, number: int, times: Iterable[int]) -> int:
    return [number for now in times for number in pace.due(now)].count(number)


HEARTBEAT, POSITION, ODOMETRY = 0, 32, 331


def test_telemetry_comes_as_often_as_it_should() -> None:
    ten_seconds = range(20_000_000, 30_000_000, 20_000)

    assert reports(Pace(), HEARTBEAT, ten_seconds) == 10
    assert reports(Pace(), POSITION, ten_seconds) == 100


@pytest.mark.parametrize("per_second", [10, 50])
def test_looked_for_late_it_comes_as_often_all_the_same(per_second: int) -> None:
    """At uneven times up to a tick and a half apart."""
    times = np.cumsum(np.random.default_rng(1).integers(5_000, 15_000, 1000)).tolist()
    pace = Pace()
    pace.set(ODOMETRY, 1e6 / per_second)

    assert reports(pace, ODOMETRY, times) == pytest.approx(per_second * times[-1] * 1e-6, abs=2)


def test_after_a_pause_little_is_made_up_for() -> None:
    pace = Pace()
    pace.due(0)

    assert reports(pace, POSITION, range(10_000_000, 10_050_000, 1_000)) <= 2


@pytest.mark.parametrize(("interval", "count"), [(500_000.0, 20), (-1.0, 0), (0.0, 100)])
def test_the_pace_can_be_set(services: Services, interval: float, count: int) -> None:
    asker = Asker(pace=Pace())
    (ack,) = services.answer(frame(command(511, ODOMETRY, interval)), STATE, asker)

    assert isinstance(ack, CommandAck)
    assert ack.result == mavlink.MAV_RESULT_ACCEPTED
    assert asker.pace is not None
    assert reports(asker.pace, ODOMETRY, range(0, 10_000_000, 20_000)) == count


def test_who_is_sent_no_telemetry_has_no_pace_to_set(services: Services) -> None:
    assert result(services, 511, ODOMETRY, 1e6) == mavlink.MAV_RESULT_UNSUPPORTED


# Who asks too much, and who may not


def test_answers_are_rationed_and_commands_are_obeyed_all_the_same(services: Services) -> None:
    services.arming.arm()
    asker = Askers().heard_from("somewhere", 0.0)
    told = [
        answer
        for _ in range(148)
        for answer in services.answer(frame(ParamRequestList(1, 1)), STATE, asker)
    ]
    assert 0 < len(told) <= 64
    assert services.answer(frame(command(STOP, 1.0)), STATE, asker) == []
    assert services.arming.stopped


def test_each_asker_has_a_ration_of_its_own_that_fills_up() -> None:
    askers = Askers()
    askers.heard_from("one", 0.0).granted([Ping(0, 0, 0, 0)] * 1000)

    assert askers.heard_from("one", 0.0).room == 0
    assert askers.heard_from("other", 0.0).room == 64
    assert askers.heard_from("one", 0.5).room == 32


def test_however_many_ask_only_so_many_are_known() -> None:
    askers = Askers()
    first = askers.heard_from("first", 0.0)
    for number in range(1000):
        askers.heard_from(number, 1.0)

    assert len(askers.known()) == 16
    assert askers.heard_from("first", 1.0) is first
    late = askers.heard_from("late", 2.0)
    assert late is askers.heard_from("later", 2.0), "all others share a ration"
    assert askers.heard_from("much later", 20.0) is not late


@pytest.mark.parametrize("number", [RESET, 520, 511, 512, STOP, ARM])
def test_who_is_not_trusted_may_see_arm_and_stop(services: Services, number: int) -> None:
    numbers = {ARM: (1.0,), STOP: (1.0,), 511: (0.0, 1e6), 512: (0.0,)}.get(number, (1.0, 1.0, 1.0))
    asker = Asker(pace=Pace())
    ack, *_ = services.answer(frame(command(number, *numbers)), STATE, asker, trusted=False)

    assert isinstance(ack, CommandAck)
    denied = ack.result == mavlink.MAV_RESULT_DENIED
    assert denied is (number == RESET)
    assert services.arming.take_reset() is None


@pytest.mark.parametrize("name", [b"V_MAX", b"LINK_TIMEOUT"])
def test_who_is_not_trusted_sets_nothing(services: Services, name: bytes) -> None:
    held = services.parameters[name.decode()]
    message = ParamSet(60.0, 1, 1, name, REAL32)
    refusal, answer = services.answer(frame(message), STATE, trusted=False)

    assert refusal == ParamError(-1, *GCS, name, mavlink.MAV_PARAM_ERROR_PERMISSION_DENIED)
    assert isinstance(answer, ParamValue)
    assert services.parameters[name.decode()] == held


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
    heartbeat = REPORTS[0](STATE, services.arming)

    assert isinstance(heartbeat, Heartbeat)
    assert heartbeat.type == mavlink.MAV_TYPE_GROUND_ROVER
    assert bool(heartbeat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED) is armed
    assert heartbeat.system_status == status


# Anything at all

NUMBERS = st.floats(width=32)
BYTE = st.integers(0, 255)
REQUESTS = st.one_of(
    st.builds(CommandLong, *[NUMBERS] * 7, st.integers(0, 65535), BYTE, BYTE, BYTE),
    st.builds(
        CommandLong,
        *[NUMBERS] * 7,
        st.sampled_from([400, 185, 511, 512, 520, RESET]),
        st.just(1),
        st.just(1),
        BYTE,
    ),
    st.builds(ParamSet, NUMBERS, st.just(1), st.just(1), st.binary(max_size=16), BYTE),
    st.builds(
        ParamSet, NUMBERS, st.just(1), st.just(1), st.sampled_from([b"V_MAX", b"DELAY_N"]), BYTE
    ),
    st.builds(ParamRequestRead, st.integers(-(2**15), 2**15 - 1), BYTE, BYTE, st.binary()),
    st.builds(Ping, BYTE, BYTE, BYTE, BYTE),
    st.builds(Timesync, BYTE, BYTE),
)


@given(st.lists(REQUESTS, max_size=20))
def test_no_request_raises_and_every_answer_can_be_sent(requests: list[Message]) -> None:
    services = Services(standard_parameters(10, 20, Safety()), timesync=Timesyncing(lambda: 1))
    sender = Sender(1, 1)
    for request in requests:
        for answer in ask(services, request):
            sender.frame(answer)
        assert 0.0 <= services.parameters["V_MAX"] <= 100.0
        assert services.parameters["DELAY_N"] == 10
