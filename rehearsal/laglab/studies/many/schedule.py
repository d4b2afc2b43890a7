"""What a link does to a run, without running it: which command is in force when, which measurements
come when, and what the station then knows of the past.

All of that depends on the link and on its seed, not on where the robot is, as long as it follows
its commands. So here a run's link and both its ends are gone through with tokens for speeds: (c, a)
for the share a of the command made at tick c.
"""

from collections.abc import Iterable
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from laglab.runs.robot_side import link_fates
from laglab.scenario import Scenario
from laglab_control import MEMORY, InForce, Told, Vector
from laglab_control.batch.impaired import Arrivals, Course, Missing, News, Tokens
from laglab_gateway import Channel, Safety
from laglab_gateway.drive import Drive, follow, rejection, speeds, supervise
from laglab_gateway.memory import Owed, SpeedMemory
from laglab_protocol import (
    ROBOT,
    UNANNOUNCED,
    Applied,
    Command,
    Measurement,
    Recall,
)
from laglab_station import Questions, echoes, recalled

Token = tuple[float, float]
"""The tick of a command, and the share of it that is in force."""
STANDING: Token = (0.0, 0.0)


class Schedule(NamedTuple):
    """Of a run."""

    course: Course
    beyond: bool
    """Whether something reaches further back than everybody remembers, or the robot stands for so
    long that its station does not believe any more that it does as it is sent."""


def schedule_of(scenario: Scenario) -> Schedule:
    """Of the run of that scenario; runs that differ in other things than the link share one."""
    only_the_link = {"sample_time", "seed", "duration", "link", "safety"}
    return _schedule(Scenario(**{name: getattr(scenario, name) for name in only_the_link}))


@lru_cache(maxsize=256)
def _schedule(scenario: Scenario) -> Schedule:
    robot, station, record = _Robot(scenario), _Station(scenario.link.command_delay), _Record()
    immediate = scenario.link.command_delay == 0
    for tick in range(scenario.must_end() + 1):
        came = robot.open_tick(tick)
        if not immediate:
            robot.settle(tick)
        asks = station.answer(tick, came, record)
        robot.hear(tick, asks)
        if immediate:
            robot.settle(tick)
        record.applied.append(robot.in_force)
    course = record.course()
    too_far = robot.most_at_once >= UNANNOUNCED or course.reach >= MEMORY
    return Schedule(course, too_far or station.has_seen_it_stand)


def _no_bytes(_: object) -> bytes:
    """For a link that does not look at them."""
    return b""


class _Robot:
    """The robot's side of the link (`laglab_gateway.Gateway`): its channels, what is in force."""

    def __init__(self, scenario: Scenario) -> None:
        n, m = scenario.link.command_delay, scenario.link.measurement_delay
        fates, Ts = link_fates(scenario), scenario.sample_time
        self._commands: Channel[Command | Recall] = Channel(
            "command", n, Ts, fates.get("command"), _no_bytes
        )
        self._measurements: Channel[Measurement | Applied] = Channel(
            "measurement", m, Ts, fates.get("measurement"), _no_bytes
        )
        self._sample_time = Ts
        timeout, ramp = scenario.safety.link_timeout, scenario.safety.ramp
        self._safety = Safety(link_timeout=timeout, ramp=ramp)
        self._drive = Drive()
        self._memory, self._owed = SpeedMemory(), Owed()
        self.in_force = STANDING
        self.most_at_once = 0

    def open_tick(self, tick: int) -> list[Measurement | Applied]:
        """What comes across with this tick."""
        sample = Measurement(0.0, 0.0, 0.0, *self.in_force, tick, self._drive.command_tick)
        self._measurements.push(tick, sample)
        for told in self._owed.take():
            self._measurements.push(tick, told)
        due = self._measurements.due(tick)
        self.most_at_once = max(self.most_at_once, len(due))
        return due

    def hear(self, tick: int, asks: Iterable[Recall]) -> None:
        """The command of this tick, of speed 1: what of it is in force is then its share."""
        self._commands.push(tick, Command(1.0, 1.0, tick, *ROBOT, estimates=0))
        for ask in asks:
            self._commands.push(tick, ask)

    def settle(self, tick: int) -> None:
        """What has come across comes into force, and the failsafe watches."""
        for message in self._commands.due(tick):
            if isinstance(message, Recall):
                self._owed.owe(self._memory.answers(message))
            elif rejection(self._drive, message, self._safety) is None:
                self._drive = follow(message, tick)
        self._drive = supervise(self._drive, tick, self._sample_time, self._safety)
        share, _ = speeds(self._drive, tick, self._sample_time, self._safety)
        self.in_force = (float(self._drive.command_tick), share) if share else STANDING
        self._memory.keep(tick, self.in_force)


class _Station:
    """What a station (`laglab_station.Station`, `laglab_control.flight`) learns."""

    def __init__(self, command_delay: int) -> None:
        self._told = Told()
        self._delay = command_delay
        self._questions = Questions()
        self._believed: list[Token] = []
        self._seen = set[int]()
        self._newest = -1
        self.has_seen_it_stand = False
        """Though it had been sent to drive."""

    def answer(
        self, tick: int, came: list[Measurement | Applied], record: "_Record"
    ) -> list[Recall]:
        """What it asks at this tick; all that it knows by then goes on record."""
        measurements = [each for each in came if isinstance(each, Measurement)]
        answers = [each for each in came if isinstance(each, Applied)]
        if tick:
            self._believed.append(self._sent(tick - 1))
        if came:
            told = echoes(measurements, 0, tick)
            self._told, inputs = self._told.after(tick, told, recalled(answers, 0, tick))
            self._put_right(tick, inputs, record)
            self.has_seen_it_stand |= self._told.has_stood(self._delay)
        self._arrive(tick, measurements, record)
        record.keep(self._told, self._delay)
        return self._questions.ask(self._told, 0, tick, ROBOT)

    def _sent(self, tick: int) -> Token:
        """What is believed to be in force at `tick`."""
        made = tick - self._delay
        return (float(made), 1.0) if made >= 0 else STANDING

    def _put_right(self, tick: int, inputs: list[InForce], record: "_Record") -> None:
        known = {each.tick: _token(each) for each in inputs if each.tick >= 0}
        delay = self._told.usual_delay(otherwise=self._delay)
        if delay != self._delay:
            self._delay = delay
            known.update((j, self._sent(j)) for j in range(self._told.known + 1, tick))
        for j, token in known.items():
            if self._believed[j] != token:
                self._believed[j] = token
                record.news.append((tick, j, *token))

    def _arrive(self, tick: int, messages: list[Measurement], record: "_Record") -> None:
        settled = self._told.settled if messages else -1
        for s in sorted([message.tick for message in messages]):
            if s not in self._seen:
                self._seen.add(s)
                record.arrivals.append((tick, s, s > self._newest, s <= settled + 1))
                self._newest = max(self._newest, s)


def _token(applied: InForce) -> Token:
    command, share = applied.u.tolist()
    return command, share


class _Record:
    """Tick by tick, as it comes."""

    def __init__(self) -> None:
        self.applied: list[Token] = []
        self.news: list[tuple[int, int, float, float]] = []
        self.arrivals: list[tuple[int, int, bool, bool]] = []
        self._missing: list[tuple[int, ...]] = []
        self._told: list[tuple[int, int, int, float]] = []
        self._in_force: list[Vector] = []
        self._before: list[Vector] = []

    def keep(self, told: Told, delay: int) -> None:
        """What is known after what came at a tick."""
        usual = -1 if told.usual is None else told.usual
        self._told.append((delay, usual, told.known, told.spread))
        self._in_force.append(told.in_force)
        self._before.append(told.before)
        self._missing.append(told.missing)

    def course(self) -> Course:
        """All of it."""
        delay, usual, known, spread = np.array(self._told).T
        tick, j, *inputs = np.array(self.news).reshape(-1, 4).T
        arrived = np.array(self.arrivals, np.int64).reshape(-1, 4).T
        missing = np.array([each for tick in self._missing for each in tick], np.int64)
        return Course(
            applied=_tokens(self.applied),
            delay=delay.astype(np.int64),
            usual=usual.astype(np.int64),
            known=known.astype(np.int64),
            spread=spread,
            in_force=_tokens(self._in_force),
            before=_tokens(self._before),
            news=News(tick.astype(np.int64), j.astype(np.int64), _in_two(*inputs)),
            arrivals=Arrivals(arrived[0], arrived[1], arrived[2] > 0, arrived[3] > 0),
            missing=Missing(
                np.repeat(np.arange(len(self._missing)), list(map(len, self._missing))), missing
            ),
        )


def _tokens(tokens: Iterable[Token] | Iterable[Vector]) -> Tokens:
    commands, shares = np.array(list(tokens), np.float64).T
    return _in_two(commands, shares)


def _in_two(commands: Vector, shares: Vector) -> Tokens:
    return Tokens(commands.astype(np.int64), shares)
