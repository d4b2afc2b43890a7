"""The station's side of the link without I/O: the robot's frames in, the answer's frames out."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import starmap

import numpy as np

from laglab_control import (
    Control,
    Controller,
    PluginFailedError,
    StationConfig,
    at_tick,
    is_far,
)
from laglab_control.flight import MEMORY
from laglab_protocol import (
    STATION_COMPONENT,
    STATION_HEARTBEAT,
    STATION_SYSTEM,
    Applied,
    Command,
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
from laglab_station.hearing import Came, Coming, PlayedOut, echoes, measured, recalled
from laglab_station.joining import Rest, observe, prior
from laglab_station.recalling import Questions
from laglab_station.report import Calibrated, StationReport
from laglab_station.saying import emergency_stop_for, said
from laglab_station.warned import Warnings

LONGEST_GAP = MEMORY
"""Ticks without a word, after which nobody knows what the robot did meanwhile."""


class Station:
    """Answers each tick of the robot once with ESTIMATE (unless `raw`) and COMMAND.

    A repeated tick gets the same answer and changes nothing. A tick whose measurements did not all
    arrive gets none: the robot will repeat it. Everything else that arrives is passed over, and so
    is every other sender once a robot was heard. A robot first heard at tick 0 starts where the
    station was told; one that is already under way, or was not heard for LONGEST_GAP ticks, is
    taken over from a standstill (`joining`), and the tick at which its pose is known is its tick 0
    (docs/tick.md). One whose ticks begin again is met anew.
    """

    def __init__(
        self,
        config: StationConfig,
        controller: Callable[[StationConfig], Controller] = Controller,
        clock: Callable[[], int] | None = None,
        sender: Sender | None = None,
        settings: Settings | None = None,
        playout: int = 0,
    ) -> None:
        """`clock` [ns] times the ticks and answers TIMESYNC; without one neither is done.

        `settings` is what the robot is told to compare with; by default what `config` knows. A
        measurement is used `playout` ticks after its sampling, or as soon as it comes if that is 0.
        """
        self._config = config
        self._make_controller = controller
        self._clock = clock
        self._controller = controller(config)
        self._joining: Rest | None = None
        self._sender = sender or Sender(STATION_SYSTEM, STATION_COMPONENT)
        self.settings = settings or Settings(config.model.sample_time)
        self.robot_settings: Settings | None = None
        self._robot: tuple[int, int] | None = None
        self._coming = Coming()
        self._played_out = PlayedOut(playout) if playout else None
        self._questions = Questions()
        self._restart = Restart()
        self._first = 0
        self._control = self._controller.start()
        self._ahead: Control | None = None  # what the next tick starts from, where there was time
        self._answer: list[Message] = []
        self._tick: int | None = None
        self._outcome: End | None = None
        self._closed = False
        self._measurement_delay: int | None = None
        self._times = Durations()
        self._took: int | None = None  # the last answer [ns], until it is counted
        self._alarms = Alarms()
        self._warnings = Warnings()
        self._unjudged = False  # measurements came, and nobody has looked for warnings since

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
        return self._tick

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
            n_seen=self._control.flight.usual_delay,
            m_seen=self._measurement_delay,
            tick_p50_s=p50,
            tick_p99_s=p99,
            tick_longest_s=longest,
            warnings=self.warnings,
            alarms=tuple(self._alarms.told),
            alarms_raised=self._alarms.raised,
            gated=self._alarms.gated(self._controller, self._control),
            late=self._played_out.late if self._played_out else 0,
            emergency_stop=self._warnings.emergency_stop,
            calibration=learned,
        )

    def _learned(self) -> tuple[Calibrated, ...]:
        """What cannot be told any more is not what the report is for."""
        try:
            return tuple(starmap(Calibrated, self._controller.learned(self._control)))
        except PluginFailedError as error:
            self.warn("learned", str(error))
            return ()

    def heartbeat(self) -> list[bytes]:
        """The frames that make the station known to the robot, and what it was told."""
        return self._framed([STATION_HEARTBEAT, self.settings])

    def hear(self, frames: Sequence[Frame]) -> list[bytes]:
        """The frames to send back for these, perhaps none."""
        answers: list[Message] = []
        for frame in frames:
            answers += self._hear(frame)
        return self._framed(answers)

    def look_ahead(self) -> None:
        """Do now, while the robot is busy, what the next answer would wait for."""
        regular = self._unjudged  # a measurement came, so at the next tick one may too
        self._look_back()
        under_way = self._tick is not None and self._joining is None and self._outcome is None
        if under_way and self._ahead is None and self._tick is not None:
            with at_tick(self._tick + 1):
                self._prepare(regular)

    def _prepare(self, regular: bool) -> None:
        self._ahead = self._controller.advance(self._control)
        if regular and self._measurement_delay is not None:
            due = self._ahead.flight.tick - self._measurement_delay
            self._ahead = self._controller.expect(self._ahead, due)

    def end(self, reason: EndReason) -> list[bytes]:
        """End the run from this side: the frames to send."""
        self._outcome = End(self._tick or 0, reason)
        return self._framed([self._outcome])

    def stop_robot(self) -> list[bytes]:
        """The frames that have the robot stand still for good, said again until it does; nothing
        before it was heard."""
        if self._robot is None:
            return []
        return self._framed([emergency_stop_for(*self._robot)])

    @property
    def robot_stopped(self) -> bool:
        """Whether the robot says that somebody stopped it for good."""
        return self._warnings.emergency_stop

    def _hear(self, frame: Frame) -> list[Message]:
        sender = (frame.system, frame.component)
        if self._robot not in (None, sender):
            return []
        match frame.message:
            case Measurement() | Applied():
                self._coming.hear(frame.message)
            case Tick():
                self._robot = sender
                return self._hear_tick(frame.message)
            case End():
                return self._hear_end(frame.message)
            case Settings():
                self.robot_settings = frame.message
            case Statustext():
                self._warnings.hear(frame.message)
            case Timesync(tc1=0, ts1=asked) if self._clock:
                return [Timesync(self._clock(), asked)]
        return []

    def _hear_end(self, end: End) -> list[Message]:
        """Answered once with the same; it may itself be the answer to ours. What ends a run that
        is past ends nothing."""
        if self._tick is None or end.tick < self._tick:
            if end.reason == EndReason.DISPLACED:
                self.warn("displaced", "another station has the robot: calling until it lets go")
            return []
        answered, self._closed = self._outcome is not None, True
        self._outcome = self._outcome or end
        return [] if answered else [end]

    def _hear_tick(self, message: Tick) -> list[Message]:
        came = self._coming.take()
        if len(came.measurements) + len(came.recalled) != message.measurements:
            return []
        if self._outcome is None and self._is_new(message.tick):
            self._meet(message.tick)
        if message.tick == self._tick:
            return self._answer
        if self._outcome is None and (self._tick is None or message.tick > self._tick):
            if self._played_out:
                came = self._played_out.take(message.tick, came)
            self._advance_timed(message.tick, came)
            return self._answer
        return []

    def _is_new(self, tick: int) -> bool:
        """Whether the robot is one that we know nothing of, at its tick."""
        last = self._tick
        return last is None or tick - last > LONGEST_GAP or self._restart.shows(tick, last)

    def _meet(self, tick: int) -> None:
        """A robot that is new to us at this tick."""
        self._look_back()
        self._first, self._tick = tick, None
        self._questions = Questions()
        if self._played_out:
            self._played_out.begin_anew()
        self._alarms.handed_over(self._controller, self._control)
        if tick or self._controller.config.first_tick:
            self._controller = self._make_controller(replace(self._config, first_tick=tick))
        self._control, self._ahead = self._controller.start(), None
        self._joining = Rest() if tick > 0 and self._controller.kind.predicts else None

    def _advance_timed(self, tick: int, came: Came) -> None:
        started = self._clock() if self._clock else 0
        with at_tick(tick), np.errstate(over="ignore", invalid="ignore"):  # seen as diverged
            self._advance(tick, came)
        if self._clock:
            self._took = self._clock() - started

    def _advance(self, tick: int, came: Came) -> None:
        if self._joining is None:
            self._step(tick, came)
            return
        for measurement in came.measurements:
            self._joining = observe(self._joining, measurement, self._config.model)
        if self._joining.known:
            self._take_over(tick, self._joining)
        else:
            self._stand_still(tick)

    def _stand_still(self, tick: int) -> None:
        self._tick = tick
        self._answer = [Command(0.0, 0.0, tick, *self._peer, estimates=0)]

    def _take_over(self, tick: int, rest: Rest) -> None:
        """From the pose at which the robot stands, with nothing but standstill in flight."""
        x, P = prior(rest, self._config.model)
        if is_far(x.tolist(), self._config.goal):
            self._stand_still(tick)
            self._end_diverged(tick)
            return
        config = replace(
            self._config, initial_estimate=x, initial_covariance=P, first_tick=rest.tick
        )
        self._alarms.handed_over(self._controller, self._control)
        self._controller = self._make_controller(config)
        self._control = self._controller.start()
        self._first = self._tick = rest.tick
        self._joining = None
        self._step(tick, Came((), ()))

    def _end_diverged(self, tick: int) -> None:
        self._outcome = End(tick, EndReason.DIVERGED)
        self._answer.insert(-1, self._outcome)  # the command closes the answer

    @property
    def _peer(self) -> tuple[int, int]:
        assert self._robot is not None, "nobody was heard yet"
        return self._robot

    def _framed(self, messages: list[Message]) -> list[bytes]:
        return list(map(self._sender.frame, messages))

    def _step(self, tick: int, came: Came) -> None:
        """On to `tick`; over ticks that were lost on the way the last command is taken to hold, or
        its plan to go on, until the robot tells."""
        self._look_back()
        control = self._control
        for lost in range(0 if self._tick is None else tick - self._tick):
            control = self._controller.unanswered(control) if lost else control
            control = self._ahead or self._controller.advance(control)
            self._ahead = None
        first = self._first
        arrived = measured(came.measurements, first, tick)
        if arrived:
            self._measurement_delay = tick - first - arrived[-1].tick
        told, known = echoes(came.measurements, first, tick), recalled(came.recalled, first, tick)
        self._control = self._controller.answer(control, arrived, told, known)
        self._tick = tick
        asks = self._questions.ask(self._control.flight.told, first, tick, self._peer)
        alarms = self._alarms.note(self._controller, self._control, tick)
        self._answer = [*alarms, *said(tick, self._control, self._peer, asks)]
        self._unjudged = bool(arrived)
        pose = self._control.pose
        if pose is not None and self._controller.diverged(pose):
            self._end_diverged(tick)

    def _look_back(self) -> None:
        """Make up for what the last answer did not wait for."""
        if self._took is not None:
            self._times.add(self._took)
            self._took = None
        if self._unjudged:
            self._unjudged = False
            try:
                problem = self._controller.warning(self._control)
            except PluginFailedError as error:
                problem = str(error)
            if problem:
                self.warn("estimator", f"tick {self._tick}: {problem}")
