"""One gateway's talk with its station over one endpoint: what every pace has in common."""

from collections.abc import Callable
from dataclasses import dataclass
from time import monotonic
from typing import Protocol

from laglab_gateway.errors import StationSilentError
from laglab_gateway.loops.watch import Watch
from laglab_gateway.record.recorder import Recorder
from laglab_gateway.side import Outcome, RobotSide, from_station
from laglab_protocol import Silence

TIMESYNC_TICKS = 10
"""How often the station's clock is asked for."""

END_TRIES = 5
"""A lost END only costs the station its silence timeout, so a few tries are enough."""


@dataclass(frozen=True)
class Patience:
    """How long to wait, all in wall seconds; `connect` None waits for the station for ever."""

    repeat_after: float = 0.1
    silence: float = 3.0
    connect: float | None = None

    @property
    def robot_silence(self) -> float:
        """Of a real robot: shorter, so that the station hears of it before it gives us up."""
        return self.silence / 3


class Link(Protocol):
    """What the loops need of an endpoint."""

    @property
    def datagrams(self) -> bool:
        """Whether `receive` gives whole datagrams."""

    def send(self, data: bytes) -> None:
        """To the station."""

    def receive(self, timeout: float) -> bytes:
        """From the station; nothing when nothing came within `timeout` [s]."""

    def accept_peer(self) -> None:
        """The last bytes came from the station itself: from now on send there."""


class Conversation:
    """Sends, listens, records, and knows since when the station is silent."""

    def __init__(
        self,
        gateway: RobotSide,
        endpoint: Link,
        recorder: Recorder,
        patience: Patience,
        now: Callable[[], float] = monotonic,
        watch: Watch | None = None,
    ) -> None:
        self.now = now
        self._gateway = gateway
        self._endpoint = endpoint
        self._recorder = recorder
        self._patience = patience
        self._watch = watch or Watch(gateway.services, [])
        self._heard, self._heard_tick = now(), 0
        self._silence = Silence(endpoint.datagrams, now)

    def wait_for_station(self) -> None:
        """Until the station's first heartbeat. Raises StationSilentError."""
        started = self.now()
        while not self._gateway.connected:
            self.listen(self._patience.repeat_after)
            self._recorder.flush()
            waited = self.now() - started
            if self._patience.connect is not None and waited > self._patience.connect:
                raise StationSilentError(None, waited)

    def send(self, frames: list[bytes]) -> None:
        """Send whole frames as one datagram."""
        self._endpoint.send(b"".join(frames))
        self._recorder.frames(self._gateway.time_us, frames)

    def catch_up(self) -> None:
        """While the station thinks: write down what was, look after everybody else."""
        self._recorder.flush()
        self._look_around()

    def ask_time(self) -> None:
        """Every so many ticks: how far is the station's clock away?"""
        due = self._gateway.tick % TIMESYNC_TICKS == 0
        if due and (question := self._gateway.ask_time()):
            self.send(question)

    def listen(self, timeout: float) -> None:
        """Take what arrives, for at most `timeout` [s]."""
        data = self._endpoint.receive(timeout)
        frames = self._gateway.receive(data, whole=self._silence.after(data))
        if any(from_station(frame) for frame in frames):
            self._endpoint.accept_peer()
            self._heard, self._heard_tick = self.now(), self._gateway.tick
        self._recorder.frames(self._gateway.time_us, [frame.raw for frame in frames])
        if not self._gateway.answered:
            self._look_around()

    def _look_around(self) -> None:
        """Send what others than the loop asked for, and look after those who watch."""
        if notices := self._gateway.take_notices():
            self._watch.tell(notices)
        if replies := self._gateway.take_replies():
            self.send(replies)
        self._watch.poll(lambda: self._gateway.state)
        for name in self._watch.take_lost():
            self._gateway.announce(f"lost the watcher {name}")

    def listen_for(self, done: Callable[[], bool]) -> bool:
        """Listen until `done`, or until it is time to repeat: then False."""
        deadline = self.now() + self._patience.repeat_after
        while not done():
            if self.now() > deadline:
                return False
            self.listen(self._patience.repeat_after)
        return True

    def check_silence(self) -> None:
        """Raises StationSilentError when the station has been silent for longer than allowed."""
        silence = self.now() - self._heard
        if silence > self._patience.silence:
            raise StationSilentError(self._heard_tick, silence)

    def finish_tick(self) -> int:
        """Close the tick and record it; returns the tick."""
        row = self._gateway.close_tick()
        self._recorder.row(row)
        if rows := self._gateway.take_link_rows():
            self._recorder.link(rows)
        return row.tick

    def say_goodbye(self, outcome: Outcome) -> None:
        """Tell the station, and give it a few chances to say that it heard."""
        self.catch_up()
        for _ in range(END_TRIES):
            self.send([self._gateway.end(outcome.reason)])
            if self.listen_for(lambda: self._gateway.station_end is not None):
                return
