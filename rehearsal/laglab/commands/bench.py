"""``laglab bench``."""

from typing import Annotated

import typer
from rich.console import Console

from laglab.bench import loop as loop_bench

app = typer.Typer(help="Ratios, measured side by side in one run.", no_args_is_help=True)


@app.callback()
def bench() -> None:
    """Ratios, measured side by side in one run."""


@app.command()
def loop(
    rounds: Annotated[
        int, typer.Option(min=1, help="Each way is measured so many times; medians are shown.")
    ] = 5,
    ticks: Annotated[int, typer.Option(min=100, help="Ticks of each measurement.")] = 2000,
    realtime: Annotated[float, typer.Option(min=1.0, help="Seconds of real-time pacing.")] = 5.0,
) -> None:
    """The lock-step loop over UDP and a pty, against a bare echo and against one by hand."""
    console = Console()
    with Console(stderr=True).status("") as status:
        measured = loop_bench.measure(rounds, ticks, status.update)
        status.update("real time")
        timing = loop_bench.measure_lateness(realtime)
    console.print(loop_bench.times_table(measured), crop=False)
    console.print(loop_bench.lateness_line(timing), highlight=False, soft_wrap=True)
