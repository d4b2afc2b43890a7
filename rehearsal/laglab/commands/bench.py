"""``laglab bench``."""

from typing import Annotated

import typer
from rich.console import Console

from laglab.filter_bench import (
    FILTERPY,
    Timing,
    Turn,
    controllers,
    filters,
    timings,
    timings_table,
)

app = typer.Typer(help="Measure speeds on this machine.", no_args_is_help=True)


@app.callback()
def bench() -> None:
    """Keep the name of the one benchmark a word of its own."""


@app.command("filter")
def bench_filter(
    ticks: Annotated[int, typer.Option(min=10, help="Length of the drive.")] = 1000,
) -> None:
    """What a tick of each filter costs at m + n = 4, 40 and 400, beside filterpy's EKF."""
    console = Console()
    alone = _measured(console, "filters", filters(), (4, 40, 400), ticks)
    yardstick = FILTERPY if any(row.name == FILTERPY for row in alone) else "ekf"
    console.print(timings_table("the filter alone", alone, yardstick))
    whole = _measured(console, "controllers", controllers(), (2, 20, 200), ticks)
    console.print(timings_table("filter, extrapolation over n = m ticks, law", whole, "ekf"))
    if yardstick == "ekf":
        console.print("filterpy is not installed: `pip install filterpy` adds its EKF")


def _measured(
    console: Console, what: str, contenders: dict[str, Turn], delays: tuple[int, ...], ticks: int
) -> list[Timing]:
    with console.status(f"timing {what}"):
        return list(timings(contenders, delays, ticks))
