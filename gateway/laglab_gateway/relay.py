"""A robot with a clock of its own at the end of the link: its ticks drive everything. No I/O.

To the robot we are its station, to the station we are the robot; in between lies the link. Each
tick that the robot says has begun is one of the run. What the robot takes in during tick k comes
into force at k + 1, so a command is sent on one tick before it is due: it is in force n ticks
after its stamp, as on a simulated robot, unless n is 0; then it is one tick late.
"""

from collections import deque
from collections.abc import Mapping
from typing import NamedTuple

from msgspec.structs import replace

from laglab_gateway.config import GatewayConfig
from laglab_gateway.drive import Drive, follow
from laglab_gateway.link.fates import Fates
from laglab_gateway.link.timeline import Direction
from laglab_gateway.outcome import Outcome, reason_of
from laglab_gateway.record.trace import TraceRow
from laglab_gateway.services import RobotState, Services
from laglab_gateway.side import RobotSide
from laglab_gateway.stopping import Stopping
from laglab_protocol import (
    BEGUN_AGAIN,
    MAV_SEVERITY_ERROR,
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_HEARTBEAT,
    STATION_SYSTEM,
    UNANNOUNCED,
    UNKNOWN_DELAY,
    Applied,
    Command,
    End,
    EndReason,
    Frame,
    Measurement,
    Message,
    Planned,
    Recall,
    Restart,
    Sender,
    Settings,
    Tick,
)

UNKNOWN = (None, None, None)
MOST_ASKED = 8
"""Questions that wait for a command to go with; the station asks again."""


class RobotTick(NamedTuple):
    """A tick of the robot, with all the measurements that it announced."""

    tick: int
    samples: list[Measurement]


class Relay(RobotSide):
    """A robot at the end of a link, as its station meets it.

    For every frame of the robot that `hear_robot` says begins a tick: `close_tick`, unless it is
    the first, then `open_tick`. After anything has come from either side, `forward`.
    """

    def __init__(
        self,
        config: GatewayConfig,
        services: Services,
        fates: Mapping[Direction, Fates] | None = None,
        sender: Sender | None = None,
        to_robot: Sender | None = None,
    ) -> None:
        super().__init__(config, services, fates, sender)
        self.under_way = False
        self.robot_end: End | None = None
        self.robot_settings: Settings | None = None
        self._to_robot = to_robot or Sender(STATION_SYSTEM, STATION_COMPONENT)
        self._restart = Restart()
        self._coming: deque[Measurement | Applied] = deque(maxlen=UNANNOUNCED)
        self._asks: deque[Recall] = deque(maxlen=MOST_ASKED)
        """For the robot, with its next command."""
        self._heard = RobotTick(-1, [])
        self._last: Measurement | None = None
        self._in_force = -1

    @property
    def state(self) -> RobotState:
        """The robot by its last measurement, for those who ask."""
        last = self._last
        return RobotState(self.time_us, *(last.pose + last.speeds if last else (0.0,) * 5))

    def greeting(self) -> bytes:
        """The frames that say what the robot should have been told, and make it begin its ticks."""
        return self._to_robot.frame(self.told_robot) + self._to_robot.frame(STATION_HEARTBEAT)

    @property
    def told_robot(self) -> Settings:
        """Our settings without delays and play-out: those are the link's and ours, and the robot is
        beyond them."""
        return replace(
            self.settings,
            command_delay=UNKNOWN_DELAY,
            measurement_delay=UNKNOWN_DELAY,
            command_playout=0,
            measurement_playout=UNKNOWN_DELAY,
        )

    def hear_robot(self, frame: Frame) -> bool:
        """Take one frame of the robot; True when it begins a new tick, all announced with it.

        A tick of which a frame was lost is passed over: the robot does not repeat it.
        """
        match frame.message:
            case Measurement():
                self._coming.append(frame.message)
            case Applied():
                self._coming.append(frame.message)
                self._memory.learn(frame.message)
            case Tick(tick, announced):
                came = list(self._coming)
                self._coming.clear()
                if len(came) == announced and self._is_next(tick):
                    samples = [each for each in came if isinstance(each, Measurement)]
                    self._heard = RobotTick(tick, samples)
                    return True
            case Settings():
                self.robot_settings = frame.message
            case End():
                self.robot_end = frame.message
                self.outcome = self.outcome or Outcome(reason_of(frame.message), self.tick)
        return False

    def _is_next(self, tick: int) -> bool:
        return tick > self._heard.tick or self._restart.shows(tick, self._heard.tick)

    def open_tick(self) -> list[bytes]:
        """Begin the tick just heard; the frames for the station.

        Of a robot that has begun again the ticks go back: the time of the run goes on.
        """
        tick, samples = self._heard
        if not self.under_way:
            self.first, self._in_force = tick, tick - 1
            self._commands.first = tick
            self.under_way = True
        elif tick < self.tick:
            self._meet_anew(tick)
        self._go_to(tick)
        for sample in samples:
            self._last = sample
            self._audit(sample)
        return self._tell(samples)

    def _meet_anew(self, tick: int) -> None:
        """What was on its way to the robot, or from it, belongs to its earlier ticks."""
        self.announce(BEGUN_AGAIN, MAV_SEVERITY_ERROR)
        self.first, self._in_force = tick - (self.elapsed + 1), tick - 1
        self._answer.through = tick - 1
        self._commands.clear()
        self._commands.first = self.first
        self._measurements.clear()
        self._asks.clear()
        self.audit.command.begin_anew()
        self.audit.measurement.begin_anew()
        self._memory.forget()
        self._owed.forget()
        self._drive, self._stopping = Drive(), Stopping()

    def _audit(self, sample: Measurement) -> None:
        """n by the robot's own word: the command of the sample was in force from s - 1 on."""
        self._memory.keep(sample.tick - 1, sample.speeds)
        if self._in_force < sample.command_tick <= self._drive.command_tick:
            self._in_force = sample.command_tick
            self.audit.command.arrived(sample.command_tick, sample.tick - 1)
            self.notes.came(
                "command", sample.command_tick, sample.tick - 1, sample.tick - 1 - self.first
            )

    def forward(self) -> list[bytes]:
        """The frames for the robot: the commands that are to come into force at its next tick."""
        safety = self.safety
        frames: list[bytes] = []
        came = self._take_commands(self.tick + 1)
        for asked in came.recalls:
            self._remember(asked)
        for planned in came.ready:
            if self._follow(planned, self.tick + 1, safety):
                frames += map(self._to_robot.frame, self._allowed(planned))
                self._asks.clear()
        if not self.services.arming.armed and self.tick + 1 < self._drive.fresh:
            frames.append(self._to_robot.frame(self._end_of_plan()))
        self._say_why_stopping(self.tick + 1 - max(self._drive.fresh, self.first), safety)
        return frames

    def _end_of_plan(self) -> Command:
        """Stand still: a robot that was stopped must not go on by the plan that it has."""
        standstill = Command(
            0.0, 0.0, self._drive.command_tick + 1, ROBOT_SYSTEM, ROBOT_COMPONENT, 0
        )
        self._drive = follow(standstill, self.tick + 1)
        return standstill

    def _remember(self, asked: Recall) -> None:
        """Tell what the robot's measurements have told; the robot is asked for what they have not,
        and the station will ask again."""
        self._owed.owe(self._memory.answers(asked))
        if self._memory.lacks(asked):
            self._asks.append(asked)

    def _allowed(self, planned: Planned) -> list[Message]:
        """For the robot: the command with its stamp, after its plan, which the robot reads off by
        itself, and after what the robot is asked, which takes the estimate's place."""
        command = planned.command
        if not self.services.arming.armed:
            planned = Planned(replace(command, v=0.0, omega=0.0, plan=0))
            self._drive = follow(command, self.tick + 1)  # and no plan
        command = replace(planned.command, estimates=len(self._asks))
        return [*self._asks, *planned.frames(), command]

    def close_tick(self) -> TraceRow:
        """What happened at this tick; the next one, just heard, says what was in force."""
        row = self._row(UNKNOWN, self._sampled(), self._reported())
        self._close()
        return row

    def _sampled(self) -> tuple[float | None, float | None, float | None]:
        last = self._last
        return last.pose if last and last.tick == self.tick else UNKNOWN

    def _reported(self) -> tuple[float | None, float | None]:
        """v and ω on [t_k, t_{k+1}), which the sample of k + 1 echoes."""
        echoes = [z.speeds for z in self._heard.samples if z.tick == self.tick + 1]
        return echoes[0] if echoes else (None, None)

    def end_of_robot(self, reason: EndReason) -> bytes:
        """The frame that stops the robot."""
        return self._to_robot.frame(End(self.tick, reason))
