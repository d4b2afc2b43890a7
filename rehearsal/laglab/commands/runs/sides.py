"""`laglab gateway` and `laglab controller`: one side alone."""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import Annotated

import typer

from laglab.commands.on_scenario import on_scenario
from laglab.commands.options import (
    ForceOption,
    KeyOption,
    OutOption,
    PlantKeyOption,
    PlantOption,
    ReportOption,
)
from laglab.commands.runs.leaving import Leaving, Wishes, leaving
from laglab.commands.runs.live import LiveOption, OpenOption
from laglab.extras import STEPPING, require
from laglab.live import fed, watched_station
from laglab.progress import progress_of
from laglab.results.complete import Manner
from laglab.results.station import StationGlance, StationRecord
from laglab.runs.alone import answer_alone, serve_alone
from laglab.runs.clock import LoopClock
from laglab.runs.ending import Ending
from laglab.runs.glance import watched
from laglab.runs.robot_side import OpenRobot, Setup, open_robot, wrapped_replay
from laglab.runs.station_side import OpenStation, open_station
from laglab.scenario import Scenario
from laglab.tables import say
from laglab_gateway import FileRecorder, Patience, Surroundings
from laglab_protocol import Endpoint, Listener, open_endpoint, refuse_open_door

EndpointOption = Annotated[
    str,
    typer.Option(
        metavar="URL",
        help="udpin://HOST:PORT, udpout://HOST:PORT, serial:///dev/ttyX:BAUD or pty://PATH.",
    ),
]
UnsignedOption = Annotated[
    bool,
    typer.Option(
        "--unsigned",
        help="Let anybody who can reach the endpoints move the robot; "
        "with --key those who watch, who may see, arm and stop it.",
    ),
]


def _warn(text: str) -> None:
    say(f"warning: {text}")


def _say_whom_we_wait_for(other: str, link: Endpoint) -> None:
    """And what it is to do: two that both listen, or both call, never meet."""
    match link.name.partition(":")[0]:
        case "udpin":
            say(f"listening on {link.name}: waiting for {other}, which calls there (udpout)")
        case "udpout":
            say(f"calling {link.name}: waiting for {other}, which listens there (udpin)")
        case _:
            say(f"at {link.name}: waiting for {other}")


@on_scenario
def gateway(
    scenario: Scenario,
    endpoint: EndpointOption = "udpin://127.0.0.1:14550",
    watch: Annotated[
        list[str] | None,
        typer.Option(metavar="URL", help="A ground station may look on there; may be repeated."),
    ] = None,
    out: OutOption = None,
    force: ForceOption = False,
    plant: PlantOption = None,
    plant_key: PlantKeyOption = None,
    key: KeyOption = None,
    unsigned: UnsignedOption = False,
    disarmed: Annotated[
        bool, typer.Option("--disarmed", help="Stand still until a ground station arms the robot.")
    ] = False,
    report: ReportOption = False,
    live: LiveOption = None,
    open_: OpenOption = False,
) -> None:
    """Be the robot's side of SCENARIO, for a controller elsewhere."""
    if plant is None:
        require(STEPPING)
    wishes = Wishes(out, force, report, live, open_)
    wishes.check()
    with (
        open_robot(scenario, Setup(plant, key, not disarmed, unsigned, plant_key)) as robot,
        open_endpoint(endpoint) as link,
        _opened(watch or []) as watchers,
    ):
        for each in (link, *watchers):
            refuse_open_door(each, key, unsigned)
        manner = Manner("robot", link.name, plant or scenario.plant.called)
        with leaving(scenario, manner, wishes) as left:
            _introduce(scenario, link, watchers, disarmed)
            code = left.conclude(_served(robot, link, watchers, left))
    raise typer.Exit(code)


def _introduce(
    scenario: Scenario, link: Endpoint, watchers: Sequence[Endpoint], disarmed: bool
) -> None:
    """Say where the robot is, and what whoever starts it may not expect."""
    if said := wrapped_replay(scenario):
        say(said)
    _say_whom_we_wait_for("the controller", link)
    for each in watchers:
        say(f"a ground station may look on at {each.name}")
    if disarmed:
        say("the robot is disarmed: it stands still until a ground station arms it")


def _served(
    robot: OpenRobot, link: Endpoint, watchers: Sequence[Endpoint], left: Leaving
) -> Ending:
    """The run, to its end."""
    scenario = left.scenario
    with (
        progress_of(scenario) as told,
        fed(FileRecorder(left.directory), left.line, robot.controls) as files,
    ):
        recorder, now = watched(files, scenario)
        around = Surroundings(
            Listener(link, robot.codec.receiver),
            recorder,
            Patience(silence=scenario.silence_timeout),
            robot.watch(watchers),
            lambda tick: told(tick, now()),
            _warn,
        )
        return serve_alone(robot, around, left.last)


@contextmanager
def _opened(urls: Sequence[str]) -> Iterator[list[Endpoint]]:
    with ExitStack() as stack:
        yield [stack.enter_context(open_endpoint(url)) for url in urls]


@on_scenario
def controller(
    scenario: Scenario,
    endpoint: EndpointOption = "udpout://127.0.0.1:14550",
    out: OutOption = None,
    force: ForceOption = False,
    key: KeyOption = None,
    report: ReportOption = False,
    live: LiveOption = None,
    open_: OpenOption = False,
) -> None:
    """Be the remote station of SCENARIO, for a robot elsewhere."""
    wishes = Wishes(out, force, report, live, open_)
    wishes.check()
    with open_endpoint(endpoint) as link, open_station(scenario, key) as opened:
        manner = Manner("station", link.name, "unknown")
        with leaving(scenario, manner, wishes, suffix="-station") as left:
            _say_whom_we_wait_for("the robot", link)
            code = left.conclude(_answered(opened, link, left))
    raise typer.Exit(code)


def _answered(opened: OpenStation, link: Endpoint, left: Leaving) -> Ending:
    """The run, to its end."""
    scenario, (station, receiver) = left.scenario, opened
    with progress_of(scenario) as told:
        glance = StationGlance(scenario) if scenario.pace == "realtime" else None
        clock = LoopClock(lambda tick: told(tick, glance.now() if glance else None))
        record = StationRecord(left.directory, scenario.sample_time, _warn, clock, glance)
        onlooker = watched_station(record, left.line, station, link)
        listener = Listener(link, receiver)
        return answer_alone(station, listener, scenario.silence_timeout, onlooker, clock, left.last)
