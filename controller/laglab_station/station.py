"""The station's side of the link without I/O: the robot's frames in, the answer's frames out."""

from collections.abc import Callable, Sequence

import numpy as np

from laglab_control import (
    MEMORY,
    ConfigError,
    Controller,
    PluginFailedError,
    StationConfig,
    at_tick,
)
from laglab_protocol import (
    LONGEST_PLAN,
    STATION_COMPONENT,
    STATION_HEARTBEAT,
    STATION_SYSTEM,
    Applied,
    Durations,
    End,
    EndReason,
    Frame,
    Measurement,
    Message,
    Restart,
    Sender,
    Settings,
    Statustext,
    Tick,
    Timesync,
)
from laglab_station.alarms import Alarms
from laglab_station.driver import STANDS, Driver, MakeController
from laglab_station.hearing import Came, Hearing
from laglab_station.report import Calibrated, StationReport
from laglab_station.saying import emergency_stop_for
from laglab_station.warned import Warnings

LONGEST_GAP = MEMORY
"""Ticks without a word, after which nobody knows what the robot did meanwhile."""


class Station:
    """Answers each tick of the robot once with ESTIMATE (unless `raw`) and COMMAND.

    A repeated tick gets the same answer and changes nothing. A tick whose measurements did not all
    arrive gets none: the robot will repeat it. Of ticks that have waited only the newest gets one.
    Everything else that arrives is passed over, and so is every other sender once a robot was
    heard. A robot whose ticks begin again, or that was not heard for LONGEST_GAP ticks, is met anew
    (docs/tick.md), each time by a `Driver` of its own.
    """

    def __init__(
        self,
        config: StationConfig,
        controller: MakeController = Controller,
        clock: Callable[[], int] | None = None,
        sender: Sender | None = None,
        settings: Settings | None = None,
        playout: int = 0,
    ) -> None:
        """`clock` [ns] times the ticks and answers TIMESYNC; without one neither is done.

        `settings` is what the robot is told to compare with; by default what `config` knows. A
        measurement is used `playout` ticks after its sampling, or as soon as it comes if that is 0.

        Raises ConfigError: more is planned than a command can tell.
        """
        if config.plan > LONGEST_PLAN:
            raise ConfigError(f"plan must be {LONGEST_PLAN} or less, not {config.plan}")
        self._config = config
        self._make_controller = controller
        self._clock = clock
        self._sender = sender or Sender(STATION_SYSTEM, STATION_COMPONENT)
        self.settings = settings or Settings(config.model.sample_time)
        self.robot_settings: Settings | None = None
        self._robot: tuple[int, int] | None = None
        self._hearing = Hearing(playout)
        self._restart = Restart()
        self._answer: list[Message] = []
        self._outcome: End | None = None
        self._closed = False
        self._times = Durations()
        self._took: int | None = None  # the last answer [ns], until it is counted
        self._alarms = Alarms()
        self._warnings = Warnings()
        self._driver = Driver(config, controller, self._alarms)

    @property
    def outcome(self) -> End | None:
        """What ended the run: None while it lasts."""
        return self._outcome

    @property
    def closed(self) -> bool:
        """Whether both sides have said END."""
        return self._closed

    @property
    def tick(self) -> int | None:
        """The last tick that was answered; None before the first."""
        return self._driver.tick

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the station has to warn of, in the order in which it was found."""
        self._look_back()
        return self._warnings.texts

    def warn(self, about: str, text: str) -> None:
        """Put a warning on record, unless there is one about this already."""
        self._warnings.add(about, text)

    def report(self) -> StationReport:
        """How the run went so far."""
        self._look_back()
        learned = self._learned()
        p50, p99, longest = self._times.quantiles() or (None, None, None)
        return StationReport(
            n_seen=self._driver.command_delay,
            m_seen=self._driver.measurement_delay,
            tick_p50_s=p50,
            tick_p99_s=p99,
            tick_longest_s=longest,
            warnings=self.warnings,
            alarms=tuple(self._alarms.told),
            alarms_raised=self._alarms.raised,
            gated=self._driver.gated,
            late=self._hearing.late,
            emergency_tick=self._warnings.emergency_tick,
            calibration=learned,
        )

    def _learned(self) -> tuple[Calibrated, ...]:
        """Nothing where the estimator fails: the report is given all the same."""
        try:
            return self._driver.learned()
        except PluginFailedError as error:
            self.warn("learned", str(error))
            return ()

    def heartbeat(self) -> list[bytes]:
        """The frames that make the station known to the robot; first what it was told: where they
        come in pieces, a run begins with the heartbeat."""
        return self._framed([self.settings, STATION_HEARTBEAT])

    def hear(self, frames: Sequence[Frame]) -> list[bytes]:
        """The frames to send back for these, perhaps none. Raises PluginFailedError."""
        answers: list[Message] = []
        for frame in frames:
            answers += self._hear(frame)
        return self._framed(answers)

    def hear_backlog(self, frames: Sequence[Frame]) -> list[bytes]:
        """As `hear`, of frames that have waited: their ticks but the newest are not answered any
        more; what they brought is used all the same. Raises PluginFailedError."""
        newest = max((said.tick for said in map(self._tick_in, frames) if said), default=0)
        answers: list[Message] = []
        for frame in frames:
            if not self._is_overtaken(frame, newest):
                answers += self._hear(frame)
        return self._framed(answers)

    def look_ahead(self) -> None:
        """Do now, while the robot is busy, what the next answer would wait for.

        Raises PluginFailedError.
        """
        regular = self._driver.is_unjudged  # a measurement came, so at the next tick one may too
        self._look_back()
        if self._outcome is None:
            self._driver.look_ahead(regular)

    def end(self, reason: EndReason) -> list[bytes]:
        """End the run from this side: the frames to send."""
        self._outcome = End(self.tick or 0, reason)
        return self._framed([self._outcome])

    def stop_robot(self) -> list[bytes]:
        """The frames that have the robot stand still for good, to be said again until it does;
        none before it was heard."""
        return self._framed([emergency_stop_for(*self._robot)] if self._robot else [])

    @property
    def robot_stopped(self) -> bool:
        """Whether the robot says that somebody stopped it for good."""
        return self._warnings.emergency_tick is not None

    def _hear(self, frame: Frame) -> list[Message]:
        sender = (frame.system, frame.component)
        if self._robot not in (None, sender):
            return []
        match frame.message:
            case Measurement() | Applied():
                self._hearing.hear(frame.message)
            case Tick():
                self._robot = sender
                return self._hear_tick(frame.message)
            case End():
                return self._hear_end(frame.message)
            case Settings():
                self.robot_settings = frame.message
            case Statustext():
                self._warnings.hear(frame.message, self.tick or 0)
            case Timesync(tc1=0, ts1=asked) if self._clock:
                return [Timesync(self._clock(), asked)]
        return []

    def _tick_in(self, frame: Frame) -> Tick | None:
        """What our robot says in it, if that is a tick."""
        said = frame.message
        ours = (frame.system, frame.component) == self._robot
        return said if ours and isinstance(said, Tick) else None

    def _is_overtaken(self, frame: Frame, newest: int) -> bool:
        """Whether it is a new tick, but not the newest; what it brought is then put aside."""
        said = self._tick_in(frame)
        if said is None or self.tick is None or not self.tick < said.tick < newest:
            return False
        self.warn(
            "behind",
            f"tick {said.tick} was passed over: answers take longer than ticks, and a newer one "
            "had come",
        )
        if came := self._hearing.by(said):
            self._hearing.put_aside(said.tick, came)
        return True

    def _hear_end(self, end: End) -> list[Message]:
        """Answered once with the same; it may itself be the answer to ours. What ends a run that
        is past ends nothing."""
        if self.tick is None or end.tick < self.tick:
            if end.reason == EndReason.DISPLACED:
                self.warn("displaced", "another station has the robot: calling until it lets go")
            return []
        answered, self._closed = self._outcome is not None, True
        self._outcome = self._outcome or end
        return [] if answered else [end]

    def _hear_tick(self, message: Tick) -> list[Message]:
        came = self._hearing.by(message)
        if came is None:
            return []
        if self._outcome is None and self._is_new(message.tick):
            self._meet(message.tick)
        if message.tick == self.tick:
            return self._answer
        if self._outcome is None and (self.tick is None or message.tick > self.tick):
            self._answer_timed(message.tick, self._hearing.due(message.tick, came))
            return self._answer
        return []

    def _is_new(self, tick: int) -> bool:
        """Whether the robot is one that we know nothing of, at its tick."""
        last = self.tick
        return last is None or tick - last > LONGEST_GAP or self._restart.shows(tick, last)

    def _meet(self, tick: int) -> None:
        """A robot that is new to us at this tick."""
        self._look_back()
        self._hearing.begin_anew()
        self._warnings.met(tick, self.tick)
        if tick or self.tick is not None:
            self._driver.tick = None  # if its driver cannot be made, it was never answered
            driver = Driver(self._config, self._make_controller, self._alarms, tick)
            self._driver.leave()
            self._driver = driver

    def _answer_timed(self, tick: int, came: Came) -> None:
        assert self._robot is not None, "nobody was heard yet"
        started = self._clock() if self._clock else 0
        with at_tick(tick), np.errstate(over="ignore", invalid="ignore"):  # seen as diverged
            self._look_back()
            self._answer = self._driver.answer(tick, came, self._robot)
        if self._driver.lost:
            self._outcome = End(tick, EndReason.DIVERGED)
            self._answer.insert(-1, self._outcome)  # the command closes the answer
        if self._clock:
            self._took = self._clock() - started

    def _framed(self, messages: list[Message]) -> list[bytes]:
        return list(map(self._sender.frame, messages))

    def _look_back(self) -> None:
        """Make up for what the last answer did not wait for."""
        if self._took is not None:
            self._times.add(self._took)
            self._took = None
        try:
            problem = self._driver.warning()
        except PluginFailedError as error:
            problem = str(error)
        if problem:
            self.warn("estimator", f"tick {self.tick}: {problem}")
        if late := self._driver.too_late:
            self.warn("late", f"tick {self.tick}: {late}")
        if self._driver.stands:
            self.warn("stands", f"tick {self.tick}: {STANDS}")
