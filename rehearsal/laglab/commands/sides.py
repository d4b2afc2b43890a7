"""``laglab gateway`` and ``laglab controller``: each side on its own."""

import time
from contextlib import closing
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from laglab.commands.run import EXIT_CODES, PlantOption, progress_bar
from laglab.options import on_scenario
from laglab.scenario import Scenario
from laglab.sides import open_robot, station_config
from laglab_controller import Station, run_station
from laglab_gateway import FileRecorder, NoRecorder, Patience
from laglab_protocol import EndReason, open_endpoint

ENDPOINT_HELP = "udpin://HOST:PORT, udpout://HOST:PORT, serial:///dev/ttyX:BAUD or pty://PATH."


@on_scenario
def gateway(
    scenario: Scenario,
    endpoint: Annotated[
        str, typer.Option(metavar="URL", help=ENDPOINT_HELP)
    ] = "udpin://127.0.0.1:14550",
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Where trace.csv and robot.tlog go."),
    ] = None,
    plant: PlantOption = None,
) -> None:
    """Be the robot's side of SCENARIO: wait for a controller, run to the end."""
    console = Console(stderr=True)
    recorder = FileRecorder(out) if out else NoRecorder()
    with open_robot(scenario, plant) as serve, closing(recorder), open_endpoint(endpoint) as link:
        console.print(f"listening on {link.name}", highlight=False, soft_wrap=True)
        with progress_bar() as bar:
            task = bar.add_task(scenario.name, total=scenario.last_tick)
            outcome, _ = serve(
                link,
                recorder,
                Patience(silence=scenario.silence_timeout),
                lambda tick: bar.update(task, completed=tick),
            )
    console.print(f"{outcome.reason.name.lower()} at tick {outcome.tick}", highlight=False)
    raise typer.Exit(EXIT_CODES[outcome.reason])


@on_scenario
def controller(
    scenario: Scenario,
    endpoint: Annotated[
        str, typer.Option(metavar="URL", help=ENDPOINT_HELP)
    ] = "udpout://127.0.0.1:14550",
) -> None:
    """Be the remote station of SCENARIO: stabilise the robot at the other end."""
    with open_endpoint(endpoint) as link:
        typer.echo(f"calling {link.name}", err=True)
        station = Station(station_config(scenario), clock=time.monotonic_ns)
        end = run_station(station, link, scenario.silence_timeout)
    raise typer.Exit(EXIT_CODES[EndReason(end.reason)])
