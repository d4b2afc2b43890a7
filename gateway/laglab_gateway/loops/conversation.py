"""One gateway's talk with its station over one endpoint: what every pace has in common."""

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress

from laglab_gateway.errors import StationSilentError, TraceError
from laglab_gateway.loops.datagrams import datagrams
from laglab_gateway.loops.surroundings import READ_ON, Surroundings
from laglab_gateway.loops.unwritten import Unwritten
from laglab_gateway.loops.watch import Watch
from laglab_gateway.record.recorder import Recorder
from laglab_gateway.services import Askers, heartbeat
from laglab_gateway.side import RobotSide
from laglab_gateway.speakers import from_station
from laglab_protocol import (
    MAV_SEVERITY_ERROR,
    End,
    EndpointError,
    EndReason,
    Frame,
    Refusals,
    Settings,
    SettingsError,
    Statustext,
    differences,
    refuse_other_sample_time,
    stranger_as_station,
)

TIMESYNC_TICKS = 10
"""Ticks between two questions for the station's clock."""

END_TRIES = 5
"""A lost END only costs the station its silence timeout, so a few tries are enough ..."""
END_TRIES_OF_A_STREAM = 20
"""... but a port that closes takes with it what its far end has not read yet."""

KNOCK_PERIOD = 0.5
"""[s] Between heartbeats to a station that has not been heard."""

SETTINGS_WITHIN = 0.3
"""[s] Of the heartbeat that they follow on a stream, however slow."""

MOST_COMPARISONS = 5
"""A few stations may come in a run; whoever says ever other things is named so, once."""

TAKEN_OVER = "another station has taken over"


class Conversation:
    """Sends, listens, records, and knows since when the station is silent."""

    def __init__(self, gateway: RobotSide, around: Surroundings) -> None:
        self.now = around.now
        self._gateway = gateway
        self._around = around
        self._listener = around.station
        self._link = around.station.link
        self._recorder = around.recorder
        self._patience = around.patience
        self._watch = around.watch or Watch(gateway.services, [])
        self._heard, self._heard_tick = self.now(), 0
        self._settings: Settings | None = None
        self._comparisons = 0
        self._told: set[str] = set()
        self._askers = Askers()
        self._begun = False
        self._unwritten = Unwritten()
        self._knocked = -math.inf
        self._refusals = Refusals(self.now())

    @contextmanager
    def run(self) -> Iterator[None]:
        """However the run ends within, the station is told; Ctrl-C ends it in order."""
        try:
            yield
        except KeyboardInterrupt:
            self._gateway.stop(EndReason.INTERRUPTED)
        except BaseException:
            with suppress(TraceError):
                self._write_down()
            self._recorder = Recorder()  # it may be what failed
            with suppress(EndpointError):
                self._say_goodbye()
            raise
        self._say_goodbye()

    def wait_for_station(self) -> None:
        """Until the station's first heartbeat.

        Raises StationSilentError, and SettingsError when it ticks at another pace.
        """
        started = self.now()
        while not self._gateway.connected:
            self._knock()
            self.listen(self._patience.repeat_after)
            self._recorder.flush()
            waited = self.now() - started
            self._tell_of_keys()
            if self._patience.connect is not None and waited > self._patience.connect:
                raise StationSilentError(None, waited)
        self._hear_the_rest()
        self._begun = True
        if self._settings is None:
            self._warn("the controller does not tell its settings: nothing to compare with ours")

    def _hear_the_rest(self) -> None:
        """On a stream what follows a heartbeat, as settings may, can be a little later."""
        until = self.now() + SETTINGS_WITHIN
        while self._settings is None and not self._link.datagrams and self.now() < until:
            self.listen(self._patience.repeat_after)

    def _knock(self) -> None:
        """A station that waits at an address of its own does not know ours before we speak."""
        if self.now() - self._knocked >= KNOCK_PERIOD:
            self._knocked = self.now()
            self._link.send(
                b"".join(self._gateway.framed([heartbeat(self._gateway.services.arming)]))
            )

    def send(self, frames: Sequence[bytes]) -> None:
        """Send whole frames as one datagram."""
        self._link.send(b"".join(frames))
        self._recorder.frames(self._gateway.time_us, frames)

    def catch_up(self) -> None:
        """While the station thinks: write down what was, look after everybody else."""
        self._write_down()
        self._recorder.flush()
        self._look_around()

    def ask_time(self) -> None:
        """Every so many ticks: how far is the station's clock away?"""
        due = self._gateway.tick % TIMESYNC_TICKS == 0
        if due and (question := self._gateway.ask_time()):
            self.send(question)

    def listen(self, timeout: float) -> None:
        """Take what arrives, for at most `timeout` [s]."""
        frames = self._listener.listen(timeout)
        if frames and not self._gateway.connected:  # an END is of a past run, and no station's call
            frames = [frame for frame in frames if not isinstance(frame.message, End)]
            self._notice_stranger(frames)
        if frames and any(from_station(frame) for frame in frames):
            frames = self._of_the_station_in_force(frames)
        if frames:
            asker = self._askers.heard_from(self._link.sender, self.now())
            replies = self._gateway.hear(frames, asker)
            self._recorder.frames(self._gateway.time_us, [frame.raw for frame in frames])
            if replies:
                self._reply(replies)
        if not self._gateway.answered:
            self._look_around()

    def _notice_stranger(self, frames: Sequence[Frame]) -> None:
        """What speaks so while we wait for our station may be it, under another name."""
        said = stranger_as_station(frames, self._link.name)
        if said and "stranger" not in self._told:
            self._told.add("stranger")
            self._around.warn(said)

    def _of_the_station_in_force(self, frames: list[Frame]) -> list[Frame]:
        """All of them; while another station is in force, only those that are no station's."""
        link, now = self._link, self.now()
        if link.peer is not None and link.sender != link.peer:
            if now - self._heard < self._patience.in_force:
                link.send(self._gateway.end(EndReason.DISPLACED), to=link.sender)
                return [frame for frame in frames if not from_station(frame)]
            self._around.warn(TAKEN_OVER)
            self._watch.tell([Statustext(MAV_SEVERITY_ERROR, TAKEN_OVER.encode())])
            link.send(self._gateway.end(EndReason.DISPLACED))
        link.accept_peer()
        self._heard, self._heard_tick = now, self._gateway.tick
        return frames

    def _reply(self, frames: list[bytes]) -> None:
        """To whoever asked; what does not get there is the asker's loss, not the run's."""
        try:
            for datagram in datagrams(frames):
                self._link.offer(datagram, to=self._link.sender)
        except EndpointError as error:
            self._warn(f"an answer was not sent: {error}")
        self._recorder.frames(self._gateway.time_us, frames)
        if self._settings != self._gateway.station_settings:
            self._compare_settings()

    def _compare_settings(self) -> None:
        self._settings = self._gateway.station_settings
        assert self._settings is not None, "only a message changes it"
        self._comparisons += 1
        if self._begun and self._comparisons > MOST_COMPARISONS:
            self._warn("the controller goes on changing its settings")
            return
        try:
            refuse_other_sample_time(self._gateway.settings, self._settings)
        except SettingsError as error:
            if not self._begun:
                raise
            self._warn(str(error))  # the station came late, and will find out by itself
        if said := differences(self._gateway.settings, self._settings):
            self._warn(f"the two sides were told different things: {said}")

    def _warn(self, text: str) -> None:
        """Once: who runs the gateway, in full; who listens, in short."""
        if text not in self._told:
            self._told.add(text)
            self._around.warn(text)
            self._gateway.announce(text)

    def _tell_of_keys(self) -> None:
        """Now and then: whose frames we may not take, and how to mend that."""
        now = self.now()
        if self._refusals.are_due(now):  # else it is not worth to name them all
            for text in self._refusals.news([self._listener, *self._watch.listeners], now):
                self._around.warn(text)

    def _look_around(self) -> None:
        """Say what was announced, and look after those who watch."""
        if notices := self._gateway.take_notices():
            self._show(notices)
            self._watch.tell(notices)
            self.send(self._gateway.framed(notices))
        self._watch.poll(lambda: self._gateway.state)
        self._tell_of_keys()
        for name in self._watch.take_lost():
            self._gateway.announce(f"lost the watcher {name}")

    def _show(self, notices: Sequence[Statustext]) -> None:
        """Once each, to whoever runs the gateway: what is worse than a warning."""
        for notice in notices:
            text = notice.text.decode(errors="replace")
            if notice.severity <= MAV_SEVERITY_ERROR and text not in self._told:
                self._told.add(text)
                self._around.warn(text)

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
        for _ in range(READ_ON):
            if self._seems_silent:
                self.listen(0.0)
        if self._seems_silent:
            raise StationSilentError(self._heard_tick, self.now() - self._heard)

    @property
    def _seems_silent(self) -> bool:
        return self.now() - self._heard > self._patience.silence

    def finish_tick(self) -> None:
        """Close the tick; it is recorded when there is time."""
        self._unwritten.close_tick(self._gateway)

    def _write_down(self) -> None:
        self._unwritten.write_down(self._recorder, self._around.progress)

    def _say_goodbye(self) -> None:
        """Tell the station, and give it a few chances to say that it heard; as long as it answers
        what came before, it is behind and has not read of the end."""
        outcome = self._gateway.stop(EndReason.FAILED)
        self._write_down()
        self._recorder.flush()
        most = END_TRIES if self._link.datagrams else END_TRIES_OF_A_STREAM
        tries, latest = 0, self.now() + self._patience.silence
        while tries < most and self.now() < latest:
            heard = self._heard
            self.send(self._gateway.farewell(outcome.reason))
            if not self._gateway.connected:
                return  # nobody came who could answer
            if self.listen_for(lambda: self._gateway.station_end is not None):
                return
            tries = tries + 1 if self._heard == heard else 0
