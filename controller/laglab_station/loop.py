"""The station's thin loop: a clock and an endpoint around the core."""

from collections.abc import Sequence
from contextlib import suppress
from time import monotonic, sleep

from laglab_protocol import (
    ROBOT,
    TELLS_WITHIN,
    UNANNOUNCED,
    End,
    EndpointError,
    EndReason,
    FarEndGoneError,
    Frame,
    Heartbeat,
    Listener,
    Refusals,
    Settings,
    differences,
    refuse_other_sample_time,
    stranger_as_robot,
)
from laglab_station.errors import RobotSilentError
from laglab_station.station import Station

HEARTBEAT_PERIOD = 0.1
"""[s] between heartbeats while the robot has not been heard."""

CALL_AGAIN = 0.5
"""[s] A robot that says nothing for so long may have begun again, and wait for a heartbeat."""

IN_FORCE = 1.0
"""[s] Heard so lately, a robot keeps its station: nobody at another address takes its place."""

HURRIED = 2e-4
"""[s] After an answer that took longer it is seen whether more than one tick has come meanwhile: to
look costs a hundredth of that."""


class Onlooker:
    """Told of all that happens at the station; this one looks away."""

    def warned(self, text: str) -> None:
        """Something, in a line, that a person must not overlook."""

    def said(self, frames: Sequence[bytes], tick: int | None) -> None:
        """Whole frames crossed the link, either way, at or after the `tick` last answered."""

    def answered(self, tick: int) -> None:
        """A tick is over for the station: nobody waits for it now."""

    def close(self) -> None:
        """The run is over."""


def run_station(
    station: Station,
    listener: Listener,
    silence_timeout: float = 3.0,
    onlooker: Onlooker | None = None,
) -> End:
    """Make the station known, then answer the robot until one side ends the run; return the End.

    However it ends, the robot is told.

    Raises:
        RobotSilentError: the robot, once heard, says nothing for `silence_timeout` seconds.
        SettingsError: the robot ticks at another pace.
        PluginFailedError: what somebody brought fails.
        EndpointError: the endpoint fails, and does not come back in that time.
    """
    loop = _Loop(station, listener, silence_timeout, onlooker or Onlooker())
    try:
        loop.introduce()
        return loop.answer_until_end()
    except KeyboardInterrupt:
        with suppress(EndpointError):  # a link that is broken takes no last words
            loop.say(station.end(EndReason.INTERRUPTED))
        raise
    except BaseException:
        with suppress(EndpointError):
            listener.link.send(b"".join(station.end(EndReason.FAILED)))
        raise


class _Loop:
    def __init__(
        self, station: Station, listener: Listener, silence_timeout: float, onlooker: Onlooker
    ) -> None:
        self._station = station
        self._listener = listener
        self._link = listener.link
        self._silence_timeout = silence_timeout
        self._onlooker = onlooker
        self._warned = 0
        self._heard = monotonic()
        self._took = 0.0
        """[s] For the last answer, and what was done after it."""
        self._called = -HEARTBEAT_PERIOD
        self._compared: Settings | None = None
        self._heard_again = False
        """Whether who is in force has said more than one thing: one alone may be astray."""
        self._met: float | None = None
        """When the first tick of who is in force had come, or who it is changed."""
        self._refusals = Refusals(self._heard)

    def say(self, frames: list[bytes]) -> None:
        self._send(frames)
        self._onlooker.said(frames, self._station.tick)

    def _send(self, frames: list[bytes]) -> None:
        with suppress(FarEndGoneError):  # listening finds it gone too, and gives it time
            self._link.send(b"".join(frames))

    def introduce(self) -> None:
        while self._station.tick is None and not self._station.closed:
            self._call_every(HEARTBEAT_PERIOD)
            self._answer(HEARTBEAT_PERIOD)
            self._tell_of_keys()
        self._met = monotonic()

    def answer_until_end(self) -> End:
        try:
            self._answer_until_silence()
        except FarEndGoneError:
            if self._station.outcome is None:
                raise
        finally:
            self._miss_settings(0.0)
            self._pass_warnings_on()
        if self._station.outcome is None:
            raise RobotSilentError(
                f"{self._link.name}: the robot has been silent for {self._silence_timeout:g} s, "
                f"since its tick {self._station.tick}: see whether its process still runs and the "
                "link is up"
            )
        return self._station.outcome

    def _answer_until_silence(self) -> None:
        """Or until the run is over."""
        while not self._station.closed:
            self._tell_of_keys()
            patience = min(CALL_AGAIN, self._silence_timeout)
            until = monotonic() + patience
            if self._answer(patience):
                continue
            # Silent until then, not until now: more may have come while we were held up.
            silence = min(monotonic(), until) - self._heard
            if silence >= self._silence_timeout:
                return
            if silence >= CALL_AGAIN:
                self._call_every(CALL_AGAIN)

    def _call_every(self, period: float) -> None:
        """Bytes that are no frame yet, or never will be, make no call more frequent."""
        if monotonic() - self._called >= period:
            self._called = monotonic()
            self.say(self._station.heartbeat())

    def _answer(self, timeout: float) -> bool:
        """Whether the robot said anything."""
        frames = self._listen(timeout)
        if not frames:
            return False
        if self._took > HURRIED:
            frames += self._waiting()
            answer = self._station.hear_backlog(frames)
        else:
            answer = self._station.hear(frames)
        if answer:
            self._send(answer)
            self._station.look_ahead()
        self._onlooker.said([frame.raw for frame in frames] + answer, self._station.tick)
        if self._station.tick is not None:
            self._onlooker.answered(self._station.tick)
        self._look_around()
        self._took = monotonic() - self._heard
        return True

    def _waiting(self) -> list[Frame]:
        """What has come besides; when that is much, there is more."""
        frames: list[Frame] = []
        while len(frames) < UNANNOUNCED and (more := self._listen(0.0)):
            frames += more
        return frames

    def _listen(self, timeout: float) -> list[Frame]:
        """What the robot in force says; a link that broke is given time to come back."""
        try:
            frames = self._listener.listen(timeout)
        except FarEndGoneError as error:
            if self._station.outcome is not None:
                raise  # we have ended the run: nobody need come back
            self._reopen(error)
            return []
        if frames and self._station.tick is None:
            self._notice_stranger(frames)
        frames = [frame for frame in frames if (frame.system, frame.component) == ROBOT]
        now, link = monotonic(), self._link
        if not frames:
            return []
        if link.sender != link.peer:
            kept = link.peer is not None and now - self._heard < IN_FORCE
            if kept and (self._heard_again or not _knocks(frames)):
                return []
            self._accept_peer(now)
        else:
            self._heard_again = True
        self._heard = now
        return frames

    def _notice_stranger(self, frames: Sequence[Frame]) -> None:
        """What ticks while we wait for our robot may be it, under another name."""
        if said := stranger_as_robot(frames, self._link.name):
            self._station.warn("stranger", said)
            self._pass_warnings_on()

    def _accept_peer(self, now: float) -> None:
        """Who knocks is to hear our heartbeat at once, and has time to tell its settings."""
        self._link.accept_peer()
        self._heard_again = False
        self._met = self._met and now
        self._call_every(0.0)

    def _reopen(self, error: FarEndGoneError) -> None:
        name = self._link.name
        self._station.warn("gone", f"{name}: the far end is gone; waiting for it to come back")
        self._look_around()
        deadline = monotonic() + self._silence_timeout
        while monotonic() < deadline:
            sleep(HEARTBEAT_PERIOD)
            try:
                self._link.reopen()
            except EndpointError:
                continue
            self.say(self._station.heartbeat())
            return
        raise error

    def _look_around(self) -> None:
        """Compare what both sides were told, once the robot says it; pass warnings on."""
        robot, station = self._station.robot_settings, self._station.settings
        if robot is not None and robot is not self._compared:
            self._compared = robot
            refuse_other_sample_time(robot, station)
            if said := differences(robot, station):
                self._station.warn("settings", f"the two sides were told different things: {said}")
        self._miss_settings(TELLS_WITHIN)
        self._pass_warnings_on()

    def _pass_warnings_on(self) -> None:
        for text in self._station.warnings[self._warned :]:
            self._warned += 1
            self._onlooker.warned(text)

    def _miss_settings(self, patience: float) -> None:
        """When the robot has not told them so long [s] after its first tick."""
        if self._compared or not self._heard_again or self._met is None:
            return
        if monotonic() - self._met >= patience:
            self._station.warn("no settings", "the robot does not tell its settings")

    def _tell_of_keys(self) -> None:
        """Now and then: whose frames we may not take, and how to mend that."""
        for text in self._refusals.news([self._listener], monotonic()):
            self._station.warn(text, text)
            self._look_around()


def _knocks(frames: Sequence[Frame]) -> bool:
    """Whether a robot begins there: a tick alone may be a stray one, and would be answered."""
    return any(isinstance(frame.message, Heartbeat) for frame in frames)
