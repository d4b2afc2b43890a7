"""`laglab gateway` and `laglab controller`: each side on its own."""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from laglab.commands.options import on_scenario
from laglab.commands.run import EXIT_CODES, KeyOption, PlantOption, progress_bar
from laglab.extras import STEPPING, require
from laglab.run.pauses import short_pauses
from laglab.run.robot_side import Setup, open_robot
from laglab.run.station_side import open_station
from laglab.scenario import Scenario
from laglab_gateway import FileRecorder, NoRecorder, Patience
from laglab_protocol import Endpoint, EndReason, open_endpoint, refuse_open_door
from laglab_station import run_station

ENDPOINT_HELP = "udpin://HOST:PORT, udpout://HOST:PORT, serial:///dev/ttyX:BAUD or pty://PATH."

UnsignedOption = Annotated[
    bool,
    typer.Option(
        "--unsigned",
        help="Let anybody who can reach the endpoints move the robot; "
        "with --key those who watch, who may arm and stop it.",
    ),
]


@on_scenario
def gateway(
    scenario: Scenario,
    endpoint: Annotated[
        str, typer.Option(metavar="URL", help=ENDPOINT_HELP)
    ] = "udpin://127.0.0.1:14550",
    watch: Annotated[
        list[str] | None,
        typer.Option(metavar="URL", help="A ground station may look on there; may be repeated."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Where trace.csv and robot.tlog go."),
    ] = None,
    plant: PlantOption = None,
    key: KeyOption = None,
    unsigned: UnsignedOption = False,
    disarmed: Annotated[
        bool, typer.Option("--disarmed", help="Stand still until a ground station arms the robot.")
    ] = False,
) -> None:
    """Be the robot's side of SCENARIO: wait for a controller, run to the end."""
    if plant is None:
        require(STEPPING)
    console = Console(stderr=True)
    with (
        open_robot(scenario, Setup(plant, key, not disarmed, unsigned)) as serve,
        closing(FileRecorder(out) if out else NoRecorder()) as recorder,
        open_endpoint(endpoint) as link,
        _opened(watch or []) as watched,
        short_pauses(),
    ):
        for each in (link, *watched):
            refuse_open_door(each, key, unsigned)
            console.print(f"listening on {each.name}", highlight=False, soft_wrap=True)
        with progress_bar() as bar:
            task = bar.add_task(scenario.name, total=scenario.last_tick)
            outcome, _ = serve(
                link,
                recorder,
                Patience(silence=scenario.silence_timeout),
                lambda tick: bar.update(task, completed=tick),
                watched,
            )
    console.print(f"{outcome.reason.name.lower()} at tick {outcome.tick}", highlight=False)
    raise typer.Exit(EXIT_CODES[outcome.reason])


@contextmanager
def _opened(urls: Sequence[str]) -> Iterator[list[Endpoint]]:
    with ExitStack() as stack:
        yield [stack.enter_context(open_endpoint(url)) for url in urls]


@on_scenario
def controller(
    scenario: Scenario,
    endpoint: Annotated[
        str, typer.Option(metavar="URL", help=ENDPOINT_HELP)
    ] = "udpout://127.0.0.1:14550",
    key: KeyOption = None,
) -> None:
    """Be the remote station of SCENARIO: stabilise the robot at the other end."""
    with (
        open_endpoint(endpoint) as link,
        open_station(scenario, key) as station,
        short_pauses(),
    ):
        typer.echo(f"calling {link.name}", err=True)
        end = run_station(
            station,
            link,
            scenario.silence_timeout,
            warn=lambda text: typer.echo(f"warning: {text}", err=True),
        )
    raise typer.Exit(EXIT_CODES[EndReason(end.reason)])
