"""The gateway's loop on the clock of a real robot: ticks happen when the robot says so."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from select import select
from time import monotonic

from laglab_gateway.errors import RobotSilentError
from laglab_gateway.loops.conversation import END_TRIES, Conversation, Patience
from laglab_gateway.loops.watch import Watch
from laglab_gateway.record.recorder import Recorder
from laglab_gateway.relay import Relay
from laglab_gateway.side import Outcome
from laglab_protocol import Endpoint, EndReason, Frame, Silence


class RobotLine:
    """The relay's talk with the robot over one endpoint."""

    def __init__(self, relay: Relay, endpoint: Endpoint, patience: Patience) -> None:
        self._relay = relay
        self._endpoint = endpoint
        self._patience = patience
        self._silence = Silence(endpoint.datagrams)
        self._heard = monotonic()

    def start(self) -> None:
        """The run begins; what the robot said before is forgotten."""
        while self._endpoint.receive(0.0):
            pass
        self._heard = monotonic()
        self.greet()

    def greet(self) -> None:
        """Make a robot begin that does not tick yet."""
        self._endpoint.send(self._relay.greeting())

    def ticks(self) -> Iterator[None]:
        """Each tick of the robot that begins with what has arrived."""
        for frame in self._listen(0.0):
            if self._relay.hear(frame):
                self._heard = monotonic()
                yield

    def _listen(self, timeout: float) -> list[Frame]:
        data = self._endpoint.receive(timeout)
        frames = self._relay.receive_from_robot(data, whole=self._silence.after(data))
        if frames:
            self._endpoint.accept_peer()
        return frames

    def check_silence(self) -> None:
        """Raises RobotSilentError when the last tick was longer ago than allowed."""
        silence = monotonic() - self._heard
        if silence > self._patience.robot_silence:
            since = self._relay.tick if self._relay.under_way else None
            raise RobotSilentError(self._endpoint.name, since, silence)

    def forward(self) -> None:
        """Send what the robot is to have now."""
        if frames := self._relay.forward():
            self._endpoint.send(b"".join(frames))

    def say_goodbye(self, reason: EndReason) -> None:
        """Stop the robot, and give it a few chances to say that it heard."""
        for _ in range(END_TRIES):
            self._endpoint.send(self._relay.end_of_robot(reason))
            if self._relay.robot_end is None:
                self._hear_the_last()
            if self._relay.robot_end is not None:
                return

    def _hear_the_last(self) -> None:
        deadline = monotonic() + self._patience.repeat_after
        while self._relay.robot_end is None and (left := deadline - monotonic()) > 0:
            for frame in self._listen(left):
                self._relay.hear(frame)


def serve_remote(
    relay: Relay,
    robot: Endpoint,
    station: Endpoint,
    recorder: Recorder,
    patience: Patience,
    progress: Callable[[int], None],
    watch: Watch | None = None,
) -> Outcome:
    """Relay between robot and station to the run's last tick; `progress` is told of each.
    Those who `watch` are looked after meanwhile.

    However it ends, both sides are told, the robot first.

    Raises:
        StationSilentError: the station never came, or fell silent.
        RobotSilentError: the robot does not speak our dialect, or fell silent.
        EndpointError: one of the two links broke.
    """
    line = RobotLine(relay, robot, patience)
    conversation = Conversation(relay, station, recorder, patience, watch=watch)
    with ExitStack() as goodbyes:
        goodbyes.callback(lambda: conversation.say_goodbye(_outcome(relay)))
        goodbyes.callback(lambda: line.say_goodbye(_outcome(relay).reason))
        try:
            conversation.wait_for_station()
            line.start()
            while relay.outcome is None:
                ready, _, _ = select([robot, station], [], [], patience.repeat_after)
                if station in ready:
                    conversation.listen(0.0)
                if robot in ready:
                    _relay_ticks(relay, line, conversation, progress)
                elif not relay.under_way:
                    line.greet()
                line.forward()
                line.check_silence()
        except KeyboardInterrupt:
            relay.outcome = Outcome(EndReason.INTERRUPTED, relay.tick)
    return _outcome(relay)


def _outcome(relay: Relay) -> Outcome:
    """Without one, an error is on its way up."""
    return relay.outcome or Outcome(EndReason.FAILED, relay.tick)


def _relay_ticks(
    relay: Relay, line: RobotLine, conversation: Conversation, progress: Callable[[int], None]
) -> None:
    for _ in line.ticks():
        if relay.under_way:
            progress(conversation.finish_tick())
        if relay.outcome is not None:
            return
        conversation.check_silence()
        conversation.send(relay.open_tick())
        conversation.catch_up()
        conversation.ask_time()
