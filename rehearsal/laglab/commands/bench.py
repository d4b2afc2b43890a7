"""`laglab bench`: ratios, measured side by side in one run."""

from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from laglab import bench
from laglab.bench import codec as codec_bench
from laglab.bench import filter as filter_bench
from laglab.bench.by_hand import Link
from laglab.commands.group import group
from laglab.extras import SEEING, STEPPING, require
from laglab.files import file_place, json_of, write_whole
from laglab.progress import status
from laglab.tables import terminal
from laglab_protocol import require_terminals

RoundsOption = Annotated[int, typer.Option("--rounds", min=1, help="Turns of each contender.")]
JsonOption = Annotated[
    Path | None,
    typer.Option("--json", metavar="FILE", help="Write what was measured here too."),
]
TicksOption = Annotated[int, typer.Option("--ticks", min=10, help="Ticks of each turn.")]

app = group("Ratios, measured side by side in one run.")


@app.command("fmu")
def fmu(
    robots: Annotated[int, typer.Option(min=1, help="Size of the fleet.")] = 1000,
    ticks: TicksOption = 3000,
    rounds: RoundsOption = 5,
    json: JsonOption = None,
) -> None:
    """A step of the FMU: ours, FMPy's two ways, the fleet, plain C."""
    require(STEPPING)
    from laglab.bench import fmu as fmu_bench  # needs FMPy

    with ExitStack() as stack:
        _run(fmu_bench.bench(robots, ticks, stack), rounds, json)


@app.command("codec")
def codec(rounds: RoundsOption = 100, json: JsonOption = None) -> None:
    """Encode and decode: our codec, pymavlink's, and mavgen's C."""
    with ExitStack() as stack:
        _run(codec_bench.bench(stack), rounds, json)


@app.command("filter")
def filter_(ticks: TicksOption = 1000, rounds: RoundsOption = 8, json: JsonOption = None) -> None:
    """A tick of each filter by its delays, beside filterpy's EKF."""
    _run(filter_bench.bench(ticks), rounds, json)


@app.command("loop")
def loop(
    ticks: TicksOption = 2000,
    realtime: Annotated[float, typer.Option(min=1.0, help="Seconds of real-time pacing.")] = 5.0,
    link: Annotated[Link | None, typer.Option(help="Only over this one.")] = None,
    rounds: RoundsOption = 9,
    json: JsonOption = None,
) -> None:
    """The lock-step loop, against a bare echo and one by hand."""
    require(STEPPING)
    from laglab.bench import loop as loop_bench  # needs FMPy

    links = (link,) if link else loop_bench.LINKS
    if "serial" in links:
        require_terminals("--link serial")
    _run(loop_bench.bench(ticks, realtime, links), rounds, json)


@app.command("live")
def live(
    seconds: Annotated[float, typer.Option(min=1.0, help="Of each run, by the clock.")] = 5.0,
    rounds: RoundsOption = 5,
    json: JsonOption = None,
) -> None:
    """How late ticks begin with a live page, read by a hundred or not."""
    require(STEPPING)
    require(SEEING)
    from laglab.bench import live as live_bench  # needs FMPy

    _run(live_bench.bench(seconds), rounds, json)


@app.command("flood")
def flood(
    seconds: Annotated[float, typer.Option(min=1.0, help="Of each run, by the clock.")] = 10.0,
    rounds: RoundsOption = 3,
    json: JsonOption = None,
) -> None:
    """How late ticks begin while strangers send as fast as they can."""
    require(STEPPING)
    from laglab.bench import flood as flood_bench  # needs FMPy

    _run(flood_bench.bench(seconds), rounds, json)


@app.command("study")
def study(
    robots: Annotated[int, typer.Option(min=1, help="Robots at once.")] = 1000,
    ticks: TicksOption = 2000,
    rounds: RoundsOption = 3,
    json: JsonOption = None,
) -> None:
    """A robot's tick: many at once, one by one, numpy by hand, plain C."""
    require(STEPPING)
    from laglab.bench import study as study_bench  # needs FMPy

    with ExitStack() as stack:
        _run(study_bench.bench(robots, ticks, stack), rounds, json)


def _run(what: bench.Bench, rounds: int, json: Path | None) -> None:
    if json:
        file_place("--json", json)
    with status() as tell:
        report = bench.run(what, rounds, tell)
    bench.show(report, terminal())
    if json:
        write_whole(json, json_of(report))
