"""The gateway's loop in simulation time: no tick passes without the station's command for it."""

from collections.abc import Callable
from dataclasses import dataclass
from time import monotonic
from typing import Protocol

from laglab_gateway.core import Gateway, Outcome, from_station
from laglab_gateway.errors import StationSilentError
from laglab_gateway.recorder import Recorder
from laglab_protocol import EndReason


@dataclass(frozen=True)
class Patience:
    """How long to wait, all in seconds; ``connect`` None waits for the station for ever."""

    repeat_after: float = 0.1
    silence: float = 3.0
    connect: float | None = None


class Link(Protocol):
    """What this loop needs of an endpoint."""

    @property
    def datagrams(self) -> bool:
        """Whether ``receive`` gives whole datagrams."""

    def send(self, data: bytes) -> None:
        """To the station."""

    def receive(self, timeout: float) -> bytes:
        """From the station; nothing when nothing came within ``timeout`` [s]."""

    def accept_peer(self) -> None:
        """The last bytes came from the station itself: from now on send there."""


END_TRIES = 5
"""A lost END only costs the station its silence timeout, so a few tries are enough."""


def serve(
    gateway: Gateway,
    endpoint: Link,
    recorder: Recorder,
    patience: Patience,
    progress: Callable[[int], None],
) -> Outcome:
    """Run a gateway to its last tick; ``progress`` is told of each tick that is over.

    Ctrl-C ends the run in order: the station is told and the outcome says INTERRUPTED.

    Raises:
        StationSilentError: the station never came, or fell silent.
        CommandError: the station commanded a speed that is not finite.
        EndpointError: the link itself broke.
    """
    link = _Conversation(gateway, endpoint, recorder, patience)
    try:
        link.wait_for_station()
        while gateway.outcome is None:
            link.exchange()
            row = gateway.close_tick()
            recorder.row(row)
            progress(row.tick)
    except KeyboardInterrupt:
        gateway.outcome = Outcome(EndReason.INTERRUPTED, gateway.tick)
    link.say_goodbye(gateway.outcome)
    return gateway.outcome


class _Conversation:
    """One gateway's conversation over one endpoint."""

    def __init__(
        self, gateway: Gateway, endpoint: Link, recorder: Recorder, patience: Patience
    ) -> None:
        self._gateway = gateway
        self._endpoint = endpoint
        self._recorder = recorder
        self._patience = patience

    def wait_for_station(self) -> None:
        started = monotonic()
        while not self._gateway.connected:
            self._listen()
            waited = monotonic() - started
            if self._patience.connect is not None and waited > self._patience.connect:
                raise StationSilentError(None, waited)

    def exchange(self) -> None:
        """Send this tick until it is answered; the station answers a repeat with the same."""
        gateway, started = self._gateway, monotonic()
        self._send(gateway.open_tick())
        while not self._until(lambda: gateway.answered):
            silence = monotonic() - started
            if silence > self._patience.silence:
                raise StationSilentError(gateway.tick, silence)
            self._send(gateway.repeat_tick())

    def say_goodbye(self, outcome: Outcome) -> None:
        """Tell the station, and give it a few chances to say that it heard."""
        for _ in range(END_TRIES):
            self._send([self._gateway.end(outcome.reason)])
            if self._until(lambda: self._gateway.station_end is not None):
                return

    def _until(self, done: Callable[[], bool]) -> bool:
        """Listen until ``done``, or until it is time to repeat."""
        deadline = monotonic() + self._patience.repeat_after
        while not done():
            if monotonic() > deadline:
                return False
            self._listen()
        return True

    def _send(self, frames: list[bytes]) -> None:
        self._recorder.frames(self._gateway.time_us, frames)
        self._endpoint.send(b"".join(frames))

    def _listen(self) -> None:
        data = self._endpoint.receive(self._patience.repeat_after)
        # A silence ends an unfinished frame on a stream as the datagram's end does on UDP.
        frames = self._gateway.receive(data, whole=self._endpoint.datagrams or not data)
        if any(from_station(frame) for frame in frames):
            self._endpoint.accept_peer()
        self._recorder.frames(self._gateway.time_us, [frame.raw for frame in frames])
