"""What the robot's messages tell the controller; ticks are counted from the station's first."""

from collections import deque
from collections.abc import Sequence
from math import isfinite
from typing import NamedTuple

import numpy as np

import laglab_protocol as protocol
from laglab_control import Echo, InForce, Measured
from laglab_protocol import UNANNOUNCED, Measurement, Playout


class Came(NamedTuple):
    """What a tick of the robot brought."""

    measurements: tuple[Measurement, ...]
    recalled: tuple[protocol.Applied, ...]

    def complete(self, tick: protocol.Tick) -> bool:
        """Whether it is all that the tick tells of."""
        return len(self.measurements) + len(self.recalled) == tick.measurements


class Coming:
    """What has come since the last tick; the next one will tell whether it is whole."""

    def __init__(self) -> None:
        self._measurements: deque[Measurement] = deque(maxlen=UNANNOUNCED)
        self._recalled: deque[protocol.Applied] = deque(maxlen=UNANNOUNCED)

    def hear(self, message: Measurement | protocol.Applied) -> None:
        """One more."""
        if isinstance(message, Measurement):
            self._measurements.append(message)
        else:
            self._recalled.append(message)

    def take(self) -> Came:
        """All of it; a repeated tick brings all anew."""
        came = Came(tuple(self._measurements), tuple(self._recalled))
        self._measurements.clear()
        self._recalled.clear()
        return came


class Overtaken:
    """What ticks brought that were not answered, for a newer one had come meanwhile."""

    def __init__(self) -> None:
        self._came: deque[Came] = deque(maxlen=UNANNOUNCED)

    def hear(self, came: Came) -> None:
        """What one of them brought."""
        self._came.append(came)

    def take(self, newest: Came) -> Came:
        """All of it, and then what the newest tick brought."""
        if not self._came:
            return newest
        every = [*self._came, newest]
        self._came.clear()
        return Came(
            tuple(each for came in every for each in came.measurements),
            tuple(each for came in every for each in came.recalled),
        )


class PlayedOut:
    """The measurements of what came, all with the same delay of `bound` ticks."""

    def __init__(self, bound: int) -> None:
        self.late = 0
        """Measurements that came too late, and were not used."""
        self._playout = Playout[Measurement](bound)

    def take(self, tick: int, came: Came) -> Came:
        """What there is to hear at `tick`, when this came."""
        self.late += len(self._playout.take(tick, came.measurements))
        return Came(tuple(self._playout.due(tick)), came.recalled)

    def begin_anew(self) -> None:
        """Drop what is held: it is another robot's."""
        self._playout.clear()


class Hearing:
    """What ticks bring: as it comes, all of it when its tick tells so, and as late as it is to be
    used. A measurement is used `playout` ticks after its sampling, or at once if that is 0."""

    def __init__(self, playout: int) -> None:
        self._coming = Coming()
        self._overtaken = Overtaken()
        self._played_out = PlayedOut(playout) if playout else None

    @property
    def late(self) -> int:
        """Measurements that came too late, and were not used."""
        return self._played_out.late if self._played_out else 0

    def hear(self, message: Measurement | protocol.Applied) -> None:
        """One more."""
        self._coming.hear(message)

    def by(self, tick: protocol.Tick) -> Came | None:
        """All that came with it; None where something is missing: the robot will repeat it."""
        came = self._coming.take()
        return came if came.complete(tick) else None

    def put_aside(self, tick: int, came: Came) -> None:
        """What a tick brought that is not answered."""
        self._overtaken.hear(self._played(tick, came))

    def due(self, tick: int, came: Came) -> Came:
        """What there is to use at a tick that is answered, and brought this."""
        return self._overtaken.take(self._played(tick, came))

    def _played(self, tick: int, came: Came) -> Came:
        return self._played_out.take(tick, came) if self._played_out else came

    def begin_anew(self) -> None:
        """Drop what is put aside or held: it is another robot's."""
        self._overtaken = Overtaken()
        if self._played_out:
            self._played_out.begin_anew()


def measured(messages: Sequence[Measurement], first: int, tick: int) -> list[Measured]:
    """The poses measured from tick `first` to the present `tick`; no others make sense."""
    return [
        Measured(message.tick - first, np.array(message.pose))
        for message in messages
        if first <= message.tick <= tick
    ]


def echoes(messages: Sequence[Measurement], first: int, tick: int) -> list[Echo]:
    """The commands that were in force just before each was sampled, as far as it tells them."""
    return [
        _echo(message, first)
        for message in messages
        if first < message.tick <= tick and all(map(isfinite, message.speeds))
    ]


def recalled(messages: Sequence[protocol.Applied], first: int, tick: int) -> list[InForce]:
    """The inputs at ticks before the present one, as far as the robot recalls them."""
    if not messages:
        return []
    told = [
        (message.first + i - first, message.v[i], message.omega[i])
        for message in messages
        for i in range(min(message.count, len(message.v)))
    ]
    return [
        InForce(j, np.array((v, omega)))
        for j, v, omega in told
        if 0 <= j < tick - first and isfinite(v) and isfinite(omega)
    ]


def _echo(message: Measurement, first: int) -> Echo:
    made = message.command_tick - first
    speeds = np.array(message.speeds)
    return Echo(message.tick - first - 1, speeds, made if made >= 0 else None)
