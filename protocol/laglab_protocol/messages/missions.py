"""The messages of common.xml about missions, fences and rally points, in wire order.

What they mean is told at https://mavlink.io/en/services/mission.html. `mission_type` says which of
the three lists (MAV_MISSION_TYPE).
"""

from laglab_protocol.messages.base import Message


class MissionRequestList(Message, frozen=True):
    """Asks how many items a list has; answered with MISSION_COUNT."""

    target_system: int
    target_component: int
    mission_type: int = 0


class MissionCount(Message, frozen=True):
    """So many items there are, or are to be sent."""

    count: int
    target_system: int
    target_component: int
    mission_type: int = 0


class MissionRequest(Message, frozen=True):
    """Asks for one item, with its position as floats."""

    seq: int
    target_system: int
    target_component: int
    mission_type: int = 0


class MissionRequestInt(Message, frozen=True):
    """Asks for one item, with its position as integers."""

    seq: int
    target_system: int
    target_component: int
    mission_type: int = 0


class MissionRequestPartialList(Message, frozen=True):
    """Asks for a part of a list."""

    start_index: int
    end_index: int
    target_system: int
    target_component: int
    mission_type: int = 0


class MissionWritePartialList(Message, frozen=True):
    """Announces a part of a list."""

    start_index: int
    end_index: int
    target_system: int
    target_component: int
    mission_type: int = 0


class MissionItem(Message, frozen=True):
    """One item, its position as floats."""

    param1: float
    param2: float
    param3: float
    param4: float
    x: float
    y: float
    z: float
    seq: int
    command: int
    target_system: int
    target_component: int
    frame: int
    current: int
    autocontinue: int
    mission_type: int = 0


class MissionItemInt(Message, frozen=True):
    """One item, its position as integers."""

    param1: float
    param2: float
    param3: float
    param4: float
    x: int
    y: int
    z: float
    seq: int
    command: int
    target_system: int
    target_component: int
    frame: int
    current: int
    autocontinue: int
    mission_type: int = 0


class MissionClearAll(Message, frozen=True):
    """Asks for a list to be emptied; answered with MISSION_ACK."""

    target_system: int
    target_component: int
    mission_type: int = 0


class MissionSetCurrent(Message, frozen=True):
    """Asks to go on with another item; answered with MISSION_CURRENT."""

    seq: int
    target_system: int
    target_component: int


class MissionCurrent(Message, frozen=True):
    """Which item is being carried out, of how many (MISSION_STATE)."""

    seq: int
    total: int = 0
    mission_state: int = 0
    mission_mode: int = 0


class MissionAck(Message, frozen=True):
    """What became of a request about a list (MAV_MISSION_RESULT)."""

    target_system: int
    target_component: int
    type: int
    mission_type: int = 0
