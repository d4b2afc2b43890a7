"""One robot, driven from the tick at which it was met: what came at a tick in, its answer out."""

from collections.abc import Callable
from dataclasses import replace
from itertools import starmap

from laglab_control import Control, Controller, StationConfig, at_tick, is_far
from laglab_protocol import Command, Message
from laglab_station.alarms import Alarms
from laglab_station.hearing import Came, echoes, measured, recalled
from laglab_station.joining import Rest, observe, prior
from laglab_station.recalling import Questions
from laglab_station.report import Calibrated
from laglab_station.saying import said

MakeController = Callable[[StationConfig], Controller]

STANDS = (
    "the robot stands still, whatever it is sent: see whether it is armed, refuses such commands, "
    "gets none of them, or gets them later than n says"
)


class Driver:
    """Drives a robot that was met at its tick `first`.

    Met at tick 0, it starts where the station was told. Met later, it is taken over from a
    standstill (`joining`), and the tick at which its pose is known becomes `first`; an estimator
    that predicts nothing just goes on.
    """

    def __init__(
        self, config: StationConfig, make: MakeController, alarms: Alarms, first: int = 0
    ) -> None:
        self.tick: int | None = None
        """The last one that was answered."""
        self.lost = False
        """Whether the estimate has diverged."""
        self.measurement_delay: int | None = None
        self.is_unjudged = False
        """Measurements came, and nobody has looked for warnings since."""
        self._first = first
        """The robot's tick that is the controller's tick 0."""
        self._config = config
        self._make = make
        self._alarms = alarms
        self._controller = make(replace(config, first_tick=first))
        self._control = self._controller.start()
        self._ahead: Control | None = None
        """What the next tick starts from, where there was time."""
        rests = first > 0 and self._controller.kind.predicts
        self._joining = Rest() if rests else None
        self._questions = Questions()

    @property
    def command_delay(self) -> int:
        """n [ticks], as the robot's echoes have it."""
        return self._control.flight.usual_delay

    @property
    def stands(self) -> bool:
        """Whether the robot stands still, whatever it is sent."""
        return self._control.flight.stands

    @property
    def gated(self) -> int:
        """Measurements that were too wild to be used, by this driver and those before it."""
        return self._alarms.gated(self._controller, self._control)

    def learned(self) -> tuple[Calibrated, ...]:
        """What is known of the robot besides its pose. Raises PluginFailedError."""
        return tuple(starmap(Calibrated, self._controller.learned(self._control)))

    def warning(self) -> str | None:
        """The estimator's after the last measurements, once. Raises PluginFailedError."""
        unjudged, self.is_unjudged = self.is_unjudged, False
        return self._controller.warning(self._control) if unjudged else None

    @property
    def too_late(self) -> str | None:
        """That measurements come later than the estimator remembers, and change nothing."""
        late, most = self.measurement_delay, self._controller.kind.most_late
        if late is None or most is None or late <= most:
            return None
        name = self._config.estimator
        return f"measurements come {late} ticks late: {name} remembers {most}, and may use none"

    def leave(self) -> None:
        """The robot is another's from now on."""
        self._alarms.handed_over(self._controller, self._control)

    def look_ahead(self, regular: bool) -> None:
        """Do now what the next answer would wait for; `regular`: a measurement will likely come.

        Raises PluginFailedError.
        """
        if self.tick is None or self._joining is not None or self._ahead is not None:
            return
        with at_tick(self.tick + 1):
            self._ahead = self._controller.advance(self._control)
            if regular and self.measurement_delay is not None:
                due = self._ahead.flight.tick - self.measurement_delay
                self._ahead = self._controller.expect(self._ahead, due)

    def answer(self, tick: int, came: Came, robot: tuple[int, int]) -> list[Message]:
        """What to say to `robot` (system, component) at its `tick`. Raises PluginFailedError."""
        if self._joining is not None:
            for measurement in came.measurements:
                self._joining = observe(self._joining, measurement, self._config.model)
            if not self._joining.known or not self._take_over(self._joining):
                self.tick = tick
                return [Command(0.0, 0.0, tick, *robot, estimates=0)]
            came = Came((), ())
        return self._step(tick, came, robot)

    def _take_over(self, rest: Rest) -> bool:
        """From the pose at which the robot stands, with nothing but standstill in flight; False
        where that is FAR from the goal."""
        x, P = prior(rest, self._config.model)
        self.lost = is_far(x.tolist(), self._config.goal)
        if self.lost:
            return False
        told = replace(self._config, initial_estimate=x, initial_covariance=P, first_tick=rest.tick)
        controller = self._make(told)
        self.leave()
        self._controller = controller
        self._control = self._controller.start()
        self._first = self.tick = rest.tick
        self._joining = None
        return True

    def _step(self, tick: int, came: Came, robot: tuple[int, int]) -> list[Message]:
        """On to `tick`; over ticks that were lost on the way the last command is taken to hold, or
        its plan to go on, until the robot tells."""
        control, first = self._control, self._first
        for lost in range(0 if self.tick is None else tick - self.tick):
            control = self._controller.unanswered(control) if lost else control
            control = self._ahead or self._controller.advance(control)
            self._ahead = None
        arrived = measured(came.measurements, first, tick)
        if arrived:
            self.measurement_delay = tick - first - arrived[-1].tick
        told, known = echoes(came.measurements, first, tick), recalled(came.recalled, first, tick)
        self._control = self._controller.answer(control, arrived, told, known)
        self.tick = tick
        asks = self._questions.ask(self._control.flight.told, first, tick, robot)
        alarms = self._alarms.note(self._controller, self._control, tick)
        self.is_unjudged = bool(arrived)
        pose = self._control.pose
        self.lost = pose is not None and self._controller.diverged(pose)
        estimates = self._controller.kind.predicts
        return [*alarms, *said(tick, self._control, robot, asks, estimates)]
