"""Who asks too much, and who may not."""

import pytest

from laglab_gateway import Services
from laglab_gateway.services import Asker, Askers, Pace
from laglab_protocol import (
    AutopilotVersionRequest,
    CommandAck,
    FileTransferProtocol,
    LogRequestList,
    Message,
    MissionRequestList,
    ParamError,
    ParamRequestList,
    ParamSet,
    ParamValue,
    Ping,
    SetMode,
)
from laglab_protocol.dialect.generated import laglab as mavlink

from .asking import ARM, GCS, REAL32, RESET, STATE, STOP, command, frame


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


@pytest.mark.parametrize(
    "question",
    [
        MissionRequestList(1, 1, 0),
        LogRequestList(0, 65535, 1, 1),
        FileTransferProtocol(0, 1, 1, (0,) * 251),
        AutopilotVersionRequest(1, 1),
        SetMode(0, 1, 8),
    ],
)
def test_the_answers_to_whatever_is_asked_are_rationed(
    services: Services, question: Message
) -> None:
    asker = Askers().heard_from("somewhere", 0.0)
    told = [answer for _ in range(148) for answer in services.answer(frame(question), STATE, asker)]
    assert len(told) == 64


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


def test_room_is_made_by_whoever_was_silent_for_longest() -> None:
    askers = Askers()
    for number in range(16):
        askers.heard_from(number, 0.0)
    askers.heard_from(0, 19.0)
    askers.heard_from("new", 20.0)

    assert {address for address, _ in askers.known()} == {0, *range(2, 16), "new"}


@pytest.mark.parametrize("number", [RESET, 520, 511, 512, 410, 176, STOP, ARM])
def test_who_is_not_trusted_may_see_arm_and_stop(services: Services, number: int) -> None:
    numbers = {ARM: (1.0,), STOP: (1.0,), 511: (0.0, 1e6), 512: (0.0,), 176: (8.0, 0.0)}.get(
        number, (1.0, 1.0, 1.0)
    )
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
