"""`laglab bench`: ratios, measured side by side in one run."""

from typing import Annotated, Literal

import typer
from rich.console import Console
from rich.table import Table

from laglab.bench import codec as codec_bench
from laglab.bench import filter as filter_bench
from laglab.commands.group import group
from laglab.extras import STEPPING, require

Link = Literal["udp", "serial"]

app = group("Ratios, measured side by side in one run.")


@app.command("loop")
def bench_loop(
    rounds: Annotated[int, typer.Option(min=1, help="Each way is measured so many times.")] = 9,
    ticks: Annotated[int, typer.Option(min=100, help="Ticks of each measurement.")] = 2000,
    realtime: Annotated[float, typer.Option(min=1.0, help="Seconds of real-time pacing.")] = 5.0,
    link: Annotated[Link | None, typer.Option(help="Only over this one.")] = None,
) -> None:
    """The lock-step loop over UDP and a pty, against a bare echo and against one by hand."""
    require(STEPPING)
    from laglab.bench import loop as loop_bench  # needs FMPy

    console = Console()
    with Console(stderr=True).status("") as status:
        links = (link,) if link else loop_bench.TRANSPORTS
        measured = loop_bench.measure(rounds, ticks, status.update, links)
        status.update("real time")
        timing = loop_bench.measure_lateness(realtime)
    console.print(loop_bench.times_table(measured), crop=False)
    console.print(loop_bench.lateness_line(timing), highlight=False, soft_wrap=True)


@app.command("filter")
def bench_filter(
    ticks: Annotated[int, typer.Option(min=10, help="Length of the drive.")] = 1000,
    rounds: Annotated[int, typer.Option(min=1, help="Turns of each filter.")] = 8,
) -> None:
    """What a tick of each filter costs at m + n = 4, 40 and 400, beside filterpy's EKF."""
    console = Console()
    alone = _timed(console, "filters", filter_bench.filters(), (4, 40, 400), ticks, rounds)
    has_filterpy = any(row.name == filter_bench.FILTERPY for row in alone)
    yardstick = filter_bench.FILTERPY if has_filterpy else "ekf"
    console.print(filter_bench.timings_table("the filter alone", alone, yardstick))
    whole = _timed(console, "controllers", filter_bench.controllers(), (2, 20, 200), ticks, rounds)
    title = "filter, extrapolation over n = m ticks, law"
    console.print(filter_bench.timings_table(title, whole, "ekf"))
    if not has_filterpy:
        console.print("filterpy is not installed: `pip install filterpy` adds its EKF")


@app.command("codec")
def bench_codec(
    rounds: Annotated[int, typer.Option(min=1, help="Blocks of messages of each codec.")] = 100,
) -> None:
    """Encode and decode, signed and not: our codec, pymavlink's, and mavgen's C."""
    with Console(stderr=True).status("encoding and decoding"):
        rows = codec_bench.bench_codec(rounds)
    table = Table("", "ours, µs", "pymavlink, µs", "times faster", "C, µs", title="one message")
    for row in rows:
        ours, theirs, c = (f"{each:.2f}" for each in (row.ours_us, row.pymavlink_us, row.c_us))
        table.add_row(row.what, ours, theirs, f"{row.times_faster:.1f}", c)
    Console().print(table)


@app.command("fmu")
def bench_fmu(
    robots: Annotated[int, typer.Option(min=1, help="Size of the fleet.")] = 1000,
    ticks: Annotated[int, typer.Option(min=100, help="Steps of a single robot.")] = 3000,
) -> None:
    """One step of the FMU: ours, FMPy's two ways, the fleet per robot, a plain C loop."""
    require(STEPPING)
    from laglab.bench import fmu as fmu_bench  # needs FMPy

    with Console(stderr=True).status("stepping"):
        rows = fmu_bench.bench(robots, ticks)
    table = Table("way", "µs a robot-step", f"× {fmu_bench.PLAIN}", title="one step of the robot")
    for row in rows:
        table.add_row(row.name, f"{1e6 * row.seconds:.3f}", f"{row.ratio:.2f}")
    Console().print(table)
    seconds = {row.name: row.seconds for row in rows}
    for version in ("FMI 2", "FMI 3"):
        faster = seconds[f"{version}, FMPy's slave methods"] / seconds[f"{version}, our stepper"]
        Console().print(f"{version}: our stepper is {faster:.1f} times as fast as FMPy's methods")


def _timed(
    console: Console,
    what: str,
    contenders: dict[str, filter_bench.Turn],
    delays: tuple[int, ...],
    ticks: int,
    rounds: int,
) -> list[filter_bench.Timing]:
    with console.status(f"timing {what}"):
        return list(filter_bench.timings(contenders, delays, ticks, rounds))
