"""``laglab run``."""

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
)

from laglab.commands.options import on_scenario
from laglab.errors import RunError, ScenarioError
from laglab.extras import REHEARSING, require
from laglab.results.report import results_table, warnings, write_results
from laglab.run.rehearse import Ending, Transport, rehearse
from laglab.run.robot_side import Setup
from laglab.scenario import Scenario
from laglab_gateway import TRACE_FILE, Trace, TraceError, read_trace
from laglab_protocol import EndReason

EXIT_CODES = {
    EndReason.COMPLETED: 0,
    EndReason.DIVERGED: 3,
    EndReason.INTERRUPTED: 130,
    EndReason.FAILED: 1,
}

KeyOption = Annotated[
    Path | None,
    typer.Option("--key", metavar="FILE", help="Sign every frame; `laglab protocol keygen`."),
]
PlantOption = Annotated[
    str | None,
    typer.Option(
        metavar="URL",
        help="The real robot's link, such as serial:///dev/ttyX:BAUD: its clock sets the pace.",
    ),
]
OutOption = Annotated[
    Path | None,
    typer.Option("--out", metavar="DIR", help="Where the results go; runs/SCENARIO otherwise."),
]


@on_scenario
def run(
    scenario: Scenario,
    transport: Annotated[
        Transport, typer.Option(help="What is between the two processes; inline is one process.")
    ] = "udp",
    out: OutOption = None,
    key: KeyOption = None,
    plant: PlantOption = None,
) -> None:
    """Rehearse SCENARIO: robot and controller, the delayed link between them, and the verdict."""
    require(REHEARSING)
    if plant is not None and transport == "inline":
        raise ScenarioError("--plant: a real robot does not wait: take --transport udp or serial")
    setup = Setup(plant, key)
    directory = out or fresh_directory(Path("runs"), scenario.name)
    with progress_bar() as bar:
        task = bar.add_task(scenario.name, total=scenario.last_tick)
        ending = rehearse(
            scenario, transport, directory, lambda tick: bar.update(task, completed=tick), setup
        )
        if ending.outcome:
            bar.update(task, completed=ending.outcome.tick)
    summary = write_results(scenario, transport, ending, _trace(directory, ending), directory)
    console = Console()
    console.print(results_table(summary), crop=False, no_wrap=True)
    for warning in warnings(summary):
        Console(stderr=True).print(f"warning: {warning}", highlight=False, soft_wrap=True)
    console.print(f"{summary['verdict']}", highlight=False, soft_wrap=True)
    console.print(f"results in {directory}", highlight=False, soft_wrap=True)
    raise typer.Exit(_exit_code(ending))


def progress_bar() -> Progress:
    """Ticks done of ticks to do, if that is known, on standard error."""
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn(text_format_no_percentage=""),
        TextColumn("tick"),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        console=Console(stderr=True),
    )


def fresh_directory(parent: Path, name: str) -> Path:
    """``parent/name``, or with a number behind it where an earlier run's results are."""
    directory, number = parent / name, 1
    while directory.exists():
        number += 1
        directory = parent / f"{name}-{number}"
    return directory


def _trace(directory: Path, ending: Ending) -> Trace:
    try:
        return read_trace(directory / TRACE_FILE)
    except TraceError:
        raise RunError(ending.problem or "the run ended before its first tick") from None


def _exit_code(ending: Ending) -> int:
    return EXIT_CODES[ending.outcome.reason] if ending.outcome else RunError.exit_code
