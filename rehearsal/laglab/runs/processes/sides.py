"""The two sides of a rehearsal, each in a process of its own."""

from contextlib import ExitStack, closing
from pathlib import Path

from laglab.interrupts import put_off
from laglab.live import fed
from laglab.runs.clock import LoopClock
from laglab.runs.errors import CUT_SHORT, SIDE_ERRORS
from laglab.runs.glance import watched
from laglab.runs.pauses import short_pauses
from laglab.runs.processes.child import Tell
from laglab.runs.processes.reports import (
    Answered,
    CutShort,
    Failed,
    Finished,
    Listening,
    Order,
    Progress,
    Warned,
)
from laglab.runs.robot_side import Setup, open_robot
from laglab.runs.station_side import open_station
from laglab.runs.waiting import START
from laglab.scenario import Scenario
from laglab_gateway import FileRecorder, Patience, Surroundings
from laglab_protocol import Listener, open_endpoint
from laglab_station import run_station


def robot_side(order: Order, tell: Tell) -> None:
    """The robot's side, from opening the endpoint to the last report."""
    scenario = Scenario.from_toml(order.scenario)
    begun = False
    try:
        with ExitStack() as last:
            with (
                open_robot(scenario, _setup(order)) as robot,
                closing(FileRecorder(Path(order.directory))) as files,
                fed(files, order.live, robot.controls) as all_told,
                open_endpoint(order.url) as endpoint,
                short_pauses(),
            ):
                tell(Listening(endpoint.name))
                begun = True
                recorder, now = watched(all_told, scenario)
                clock = LoopClock(lambda tick: tell(Progress(tick, clock.seconds, now())))
                around = Surroundings(
                    Listener(endpoint, robot.codec.receiver),
                    recorder,
                    Patience(silence=scenario.silence_timeout, connect=START),
                    progress=clock,
                    warn=lambda text: tell(Warned(text)),
                )
                try:
                    (reason, tick), link, timing = robot.serve(around)
                except SIDE_ERRORS:
                    _, link, timing = robot.so_far()
                    tell(CutShort(clock.seconds, link, timing))
                    raise
                last.enter_context(put_off())  # of a run that is over everything is told
            tell(Finished(reason, tick, clock.seconds, link, timing))
    except SIDE_ERRORS as error:
        tell(Failed(str(error), begun or isinstance(error, CUT_SHORT)))


def station_side(order: Order, tell: Tell) -> None:
    """The remote station's side."""
    scenario = Scenario.from_toml(order.scenario)
    begun = False
    try:
        with (
            open_endpoint(order.url) as endpoint,
            open_station(scenario, _path(order.key)) as (station, receiver),
            short_pauses(),
        ):
            begun = True
            listener = Listener(endpoint, receiver)
            try:
                run_station(station, listener, scenario.silence_timeout)
            finally:
                tell(Answered(station.report()))
    except SIDE_ERRORS as error:
        tell(Failed(str(error), begun or isinstance(error, CUT_SHORT)))


def _setup(order: Order) -> Setup:
    return Setup(order.plant, _path(order.key), plant_key=_path(order.plant_key))


def _path(name: str | None) -> Path | None:
    return None if name is None else Path(name)
