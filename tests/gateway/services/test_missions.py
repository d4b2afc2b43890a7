"""Missions, fences and rally points are empty lists, and stay so."""

import pytest

from laglab_gateway import Services
from laglab_protocol import (
    Message,
    MissionAck,
    MissionClearAll,
    MissionCount,
    MissionCurrent,
    MissionItemInt,
    MissionRequest,
    MissionRequestInt,
    MissionRequestList,
    MissionRequestPartialList,
    MissionSetCurrent,
    MissionWritePartialList,
)
from laglab_protocol.dialect.generated import laglab as mavlink

from .asking import GCS, ask

KINDS = {
    "mission": mavlink.MAV_MISSION_TYPE_MISSION,
    "fence": mavlink.MAV_MISSION_TYPE_FENCE,
    "rally": mavlink.MAV_MISSION_TYPE_RALLY,
}


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
def test_each_list_is_empty(services: Services, kind: int) -> None:
    assert ask(services, MissionRequestList(1, 1, kind)) == [MissionCount(0, *GCS, kind)]
    assert ask(services, MissionRequestList(2, 1, kind)) == []


ITEM = MissionItemInt(0.0, 0.0, 0.0, 0.0, 0, 0, 0.0, 0, 16, 1, 1, 3, 0, 1, 1)


@pytest.mark.parametrize(
    ("request_", "expected"),
    [
        (MissionClearAll(1, 1, 1), mavlink.MAV_MISSION_ACCEPTED),
        (MissionCount(0, 1, 1, 1), mavlink.MAV_MISSION_ACCEPTED),
        (MissionCount(3, 1, 1, 1), mavlink.MAV_MISSION_NO_SPACE),
        (MissionRequest(0, 1, 1, 1), mavlink.MAV_MISSION_INVALID_SEQUENCE),
        (MissionRequestInt(0, 1, 1, 1), mavlink.MAV_MISSION_INVALID_SEQUENCE),
        (ITEM, mavlink.MAV_MISSION_INVALID_SEQUENCE),
        (MissionRequestPartialList(0, -1, 1, 1, 1), mavlink.MAV_MISSION_UNSUPPORTED),
        (MissionWritePartialList(0, 0, 1, 1, 1), mavlink.MAV_MISSION_UNSUPPORTED),
    ],
)
def test_every_other_request_gets_its_result(
    services: Services, request_: Message, expected: int
) -> None:
    assert ask(services, request_) == [MissionAck(*GCS, expected, 1)]


def test_no_item_is_current(services: Services) -> None:
    none = MissionCurrent(0, 0, mavlink.MISSION_STATE_NO_MISSION)
    assert ask(services, MissionSetCurrent(4, 1, 1)) == [none]


def test_an_acknowledgement_is_not_answered(services: Services) -> None:
    assert ask(services, MissionAck(1, 1, mavlink.MAV_MISSION_ACCEPTED)) == []
