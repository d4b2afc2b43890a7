"""How often each message is sent to one who watches."""

from laglab_protocol.dialect.generated import laglab as mavlink

SECOND_US = 1_000_000

INTERVALS_US: dict[int, int] = {
    mavlink.MAVLINK_MSG_ID_HEARTBEAT: SECOND_US,
    mavlink.MAVLINK_MSG_ID_SYS_STATUS: SECOND_US,
    mavlink.MAVLINK_MSG_ID_SYSTEM_TIME: SECOND_US,
    mavlink.MAVLINK_MSG_ID_EXTENDED_SYS_STATE: SECOND_US,
    mavlink.MAVLINK_MSG_ID_GPS_RAW_INT: SECOND_US,
    mavlink.MAVLINK_MSG_ID_HOME_POSITION: SECOND_US,
    mavlink.MAVLINK_MSG_ID_ATTITUDE: SECOND_US // 10,
    mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT: SECOND_US // 10,
    mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED: SECOND_US // 10,
    mavlink.MAVLINK_MSG_ID_ODOMETRY: SECOND_US // 10,
}
"""Until the watcher says otherwise; no other message is sent."""

NEVER, AS_USUAL = -1, 0
SHORTEST_INTERVAL_US = SECOND_US // 100


class Pace:
    """The intervals of one watcher, and when each message is due again; by any steady clock."""

    def __init__(self) -> None:
        self._intervals = dict(INTERVALS_US)
        self._due_at: dict[int, int] = {}

    def set(self, number: int, interval_us: float) -> None:
        """The interval of one message, by its id, or AS_USUAL or NEVER."""
        usual = INTERVALS_US.get(number, NEVER)
        if interval_us == AS_USUAL:
            self._intervals[number] = usual
        elif interval_us == NEVER:
            self._intervals[number] = NEVER
        else:
            self._intervals[number] = max(int(interval_us), SHORTEST_INTERVAL_US)
        self._due_at.pop(number, None)

    def due(self, now_us: int) -> list[int]:
        """The messages that it is time for."""
        return [
            number
            for number, interval_us in self._intervals.items()
            if interval_us > 0 and self._is_due(number, interval_us, now_us)
        ]

    def _is_due(self, number: int, interval_us: int, now_us: int) -> bool:
        """Counted from when it was due: being late does not add up. Of a long pause one is made
        up for."""
        due_at = self._due_at.get(number, now_us)
        if now_us < due_at:
            return False
        self._due_at[number] = max(due_at + interval_us, now_us)
        return True
