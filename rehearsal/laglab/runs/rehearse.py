"""Starting both sides, following them, and collecting what they left."""

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from queue import Empty, Queue
from time import monotonic
from typing import Literal

from laglab.live import fed
from laglab.runs.clock import LoopClock
from laglab.runs.ending import Ending
from laglab.runs.errors import CUT_SHORT, SIDE_ERRORS
from laglab.runs.glance import OnTick, watched
from laglab.runs.inline import InlineLink
from laglab.runs.looping import looping, wait_for
from laglab.runs.processes.child import LOOK_UP, Child, Inbox, Letter, started
from laglab.runs.processes.reports import (
    Answered,
    CutShort,
    Ended,
    Failed,
    Finished,
    Listening,
    Order,
    Progress,
    Warned,
)
from laglab.runs.robot_side import OpenRobot, Setup, open_robot
from laglab.runs.station_side import make_station
from laglab.runs.waiting import START
from laglab.scenario import Scenario
from laglab_control import Controller
from laglab_gateway import Outcome, Recorder, Surroundings
from laglab_protocol import STATION_COMPONENT, STATION_SYSTEM, Codec, EndReason, Listener
from laglab_station import MakeController, Station, StationReport

Transport = Literal["inline", "udp", "serial"]

NOTICE_SECONDS = 8.0
"""[s] What a gateway needs, besides the silence timeout, to say that its station is silent: on a
stream it tries for two to tell it of the end; the rest is for a busy machine."""
STILL_STARTING = 0.5
"""[s] A side that has not met the other yet has no last words."""
GOODBYE_SECONDS = 5.0
"""[s] What a side needs for its last words when the other has ended in order, on a busy machine."""


def unheard(_: object, __: object) -> None:
    """Nobody asked."""


def rehearse_inline(
    scenario: Scenario,
    recorder: Recorder,
    progress: OnTick = unheard,
    setup: Setup | None = None,
    controller: MakeController = Controller,
) -> Ending:
    """Both sides in this process: the same bytes, with nothing between them."""
    setup = setup or Setup()
    recorder, now = watched(recorder, scenario)
    clock = LoopClock(lambda tick: progress(tick, now()))
    warnings: list[str] = []
    station: Station | None = None
    robot: OpenRobot | None = None
    try:
        with (
            open_robot(scenario, setup) as robot,
            Codec(STATION_SYSTEM, STATION_COMPONENT, setup.key) as codec,
            fed(recorder, setup.live, robot.controls) as told,
        ):
            station = make_station(scenario, codec.sender, controller)
            link = InlineLink(station, codec.receiver)
            listener = Listener(link, robot.codec.receiver)
            around = Surroundings(listener, told, progress=clock, warn=warnings.append)
            with looping(setup.last):
                served = robot.serve(around)
    except SIDE_ERRORS as error:
        begun = clock.seconds > 0 or isinstance(error, CUT_SHORT)
        ending = Ending(problem=str(error), begun=begun)
        if robot is not None:
            so_far = robot.so_far()
            ending = replace(ending, link=so_far.link, timing=so_far.timing)
    else:
        ending = Ending(served.outcome, link.problem, link=served.link, timing=served.timing)
    ending = replace(ending, loop_seconds=clock.seconds).warned(warnings)
    return _with_station(ending, station.report()) if station else ending


def _with_station(ending: Ending, report: StationReport) -> Ending:
    return replace(ending, station=report).warned(report.warnings)


def rehearse_apart(
    scenario: Scenario,
    transport: Transport,
    directory: Path,
    progress: OnTick = unheard,
    setup: Setup | None = None,
) -> Ending:
    """Each side in a process of its own; the robot's leaves its record in `directory`.

    Ctrl-C ends both in order; the outcome says so.
    """
    setup = setup or Setup()
    key, plant_key = _spelled(setup.key), _spelled(setup.plant_key)
    with _gateway_url(transport) as url:
        order = Order(
            scenario.to_toml(), url, str(directory), setup.plant, key, plant_key, setup.live
        )
        inbox: Inbox = Queue()
        with started("gateway", "laglab.runs.processes.sides:robot_side", order, inbox) as gateway:
            return _Rehearsal(gateway, inbox, scenario, setup, progress).follow()


def _spelled(path: Path | None) -> str | None:
    return None if path is None else str(path)


@contextmanager
def _gateway_url(transport: Transport) -> Iterator[str]:
    if transport == "udp":
        yield "udpin://127.0.0.1:0"
    else:
        with tempfile.TemporaryDirectory(prefix="laglab-") as directory:
            yield f"pty://{directory}/robot"


def far_end(address: str) -> str:
    """The address a station opens to reach a gateway that listens at ``address``."""
    scheme, _, place = address.partition("://")
    return f"udpout://{place}" if scheme == "udpin" else f"serial://{place}:57600"


class _Rehearsal:
    """Two sides in processes of their own, as their reports come in."""

    def __init__(
        self,
        gateway: Child,
        inbox: Inbox,
        scenario: Scenario,
        setup: Setup,
        progress: OnTick,
    ) -> None:
        self._gateway = gateway
        self._inbox = inbox
        self._scenario = scenario
        self._setup = setup
        self._progress = progress
        self._ending = Ending(begun=False)
        self._finished = self._over = self._station_over = self._interrupted = False
        self._problems: list[str] = []

    def follow(self) -> Ending:
        """Until both sides have said their last."""
        address = self._first_address()
        if address is None:
            return self._summed_up()
        order = Order(self._scenario.to_toml(), far_end(address), key=_spelled(self._setup.key))
        with started("controller", "laglab.runs.processes.sides:station_side", order, self._inbox):
            try:
                self._read_on(self._scenario.silence_timeout + NOTICE_SECONDS)
            except KeyboardInterrupt:
                self._interrupted = True
                self._gateway.stop()
                self._read_on(GOODBYE_SECONDS if self._ending.begun else STILL_STARTING)
            wait_for(self._setup.last)
        return self._summed_up()

    def _first_address(self) -> str | None:
        deadline = monotonic() + START
        while not self._over:
            if monotonic() > deadline:
                called = self._scenario.plant.called
                self._fail(f"the robot's side did not start within {START:g} s: {called}", False)
                return None
            match self._next_letter():
                case _, Listening(address):
                    return address
                case _, report:
                    self._take_of_gateway(report)
        return None

    def _next_letter(self, patience: float = LOOK_UP) -> Letter | None:
        """None when none came within so many seconds; at once, with 0, when none is there."""
        with suppress(Empty):
            return self._inbox.get(block=patience > 0, timeout=patience)
        return None

    def _read_on(self, patience: float) -> None:
        """A side whose far end is gone gets `patience` [s] to find and say so, and no longer."""
        deadline = None
        while not (self._over and self._station_over):
            if deadline is None and (self._over or self._station_over):
                deadline = monotonic() + patience
            late = deadline is not None and monotonic() > deadline
            match self._next_letter(0.0 if late else LOOK_UP):
                case None if late:
                    self._give_up()
                    break
                case sender, report if sender is self._gateway:
                    self._take_of_gateway(report)
                case _, report:
                    self._take_of_station(report)

    def _give_up(self) -> None:
        """A side that is told of its far end's end, and says nothing of it."""
        if not self._over:
            called = self._scenario.plant.called
            said = f"the robot's process does not go on: it may be that {called} does not return"
            self._fail(said, begun=True)

    def _take_of_gateway(self, report: object) -> None:
        ending = self._ending
        match report:
            case Progress(tick, seconds, glance):
                self._ending = replace(ending, begun=True, loop_seconds=seconds)
                self._progress(tick, glance)
            case Warned(text):
                self._ending = ending.warned([text])
            case Finished(reason, tick, seconds, link, timing):
                outcome = Outcome(EndReason(reason), tick)
                self._ending = replace(
                    ending, outcome=outcome, loop_seconds=seconds, link=link, timing=timing
                )
                self._finished = True
            case CutShort(seconds, link, timing):
                self._ending = replace(ending, loop_seconds=seconds, link=link, timing=timing)
            case Failed(reason, begun):
                self._fail(reason, begun)
            case Ended(how):
                self._over = True
                if not (self._finished or self._problems):
                    self._fail(how, begun=True)

    def _take_of_station(self, report: object) -> None:
        match report:
            case Answered(station):
                self._ending = _with_station(self._ending, station)
            case Failed(reason, begun):
                self._fail(reason, begun)
                if not begun:
                    self._gateway.stop()  # nobody will ever call there
            case Ended(how):
                self._station_over = True
                if self._ending.station is None and not self._problems:
                    self._fail(how, begun=True)

    def _fail(self, reason: str, begun: bool) -> None:
        if reason not in self._problems:
            self._problems.append(reason)
        self._ending = replace(self._ending, begun=self._ending.begun or begun)

    def _summed_up(self) -> Ending:
        ending = self._ending
        if self._problems and not (ending.begun or self._interrupted):
            ending = replace(ending, outcome=None)  # the side that was left was stopped by us
        if ending.outcome is not None and ending.outcome.reason is not EndReason.FAILED:
            return ending.warned(self._problems)
        return replace(ending, problem="; ".join(self._problems))
