"""`laglab link`: the link you have, measured."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import typer

from laglab.commands.group import group
from laglab.commands.options import KeyOption, WidthOption
from laglab.extras import DRAWING, require
from laglab.files import file_place, write_whole
from laglab.interrupts import put_off
from laglab.link import (
    FittedLink,
    How,
    LinkPlaceError,
    ProbePlan,
    choices_table,
    draw_fit,
    fit_table,
    link_toml,
    print_measured,
    read_link,
    read_measured,
    read_table,
    real_sizes,
    replaying,
    scenario_toml,
    suggestions,
    write_link_log,
)
from laglab.link import echo as answer
from laglab.link import fit as fit_link
from laglab.link import probe as measure
from laglab.progress import counting
from laglab.results.figures.saving import picture_place, save
from laglab.runs.station_side import station_config
from laglab.scenario import load
from laglab.tables import say, terminal
from laglab_control import PolarLaw, delay_margin
from laglab_gateway import Impairments
from laglab_protocol import (
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_SYSTEM,
    UNKNOWN_DELAY,
    Codec,
    Listener,
    Sender,
    open_endpoint,
    refuse_open_door,
)

PATIENT = 0.5
"""[s] Nobody sends a probe again: the rest of one is waited for longer than in a loop."""

app = group("The link you have: measured, imported, fitted.")

UrlArgument = Annotated[
    str,
    typer.Argument(
        metavar="URL", help="udpin://HOST:PORT, udpout://HOST:PORT or serial:///dev/ttyX:BAUD."
    ),
]
IntervalOption = Annotated[
    float,
    typer.Option("--interval", min=0.001, max=10.0, metavar="S", help="From frame to frame [s]."),
]
ClocksOption = Annotated[
    float | None,
    typer.Option(
        "--clocks-within",
        min=0.0,
        metavar="S",
        help="The clocks of both machines agree within so many seconds (PTP, GPS; 0: it is one "
        "machine). Then delays are one-way; else half of the shortest round trip is each way's.",
    ),
]


@app.command("echo")
def echo(
    url: UrlArgument = "udpin://127.0.0.1:14550",
    key: KeyOption = None,
    unsigned: Annotated[
        bool, typer.Option("--unsigned", help="Answer anybody who can reach the endpoint.")
    ] = False,
) -> None:
    """Answer whoever measures the link.

    At the robot's end, until Ctrl-C.
    """
    with Codec(ROBOT_SYSTEM, ROBOT_COMPONENT, key) as codec, open_endpoint(url) as link:
        refuse_open_door(link, key, unsigned, harm="have frames sent to others")
        say(f"at {link.name}: waiting for `laglab link probe`; Ctrl-C ends it")
        answer(Listener(link, codec.receiver, silence=PATIENT), codec, say)


@app.command("probe")
def probe(
    url: UrlArgument = "udpout://127.0.0.1:14550",
    out: Annotated[
        Path, typer.Option("--out", metavar="FILE", help="What happened to every frame.")
    ] = Path("link.csv"),
    duration: Annotated[
        float, typer.Option(min=0.05, max=86400.0, help="How long it is measured [s].")
    ] = 10.0,
    interval: IntervalOption = 0.01,
    wait: Annotated[
        float, typer.Option(min=0.1, max=3600.0, help="So long somebody must answer [s].")
    ] = 3.0,
    clocks_within: ClocksOption = None,
    key: KeyOption = None,
) -> None:
    """Measure the link, into link.csv.

    From the station's end, to `laglab link echo` or a robot that knows it: frames of the size and
    at the rate of a run's, both ways. Ctrl-C keeps what was measured.
    """
    if url.startswith("udpin"):
        raise LinkPlaceError(
            f"{url}: whoever measures calls: give udpout://HOST:PORT here, udpin to the echo"
        )
    file_place("--out", out)
    count = max(1, round(duration / interval))
    plan = ProbePlan(count, interval, wait, clocks_within)
    with (
        Codec(STATION_SYSTEM, STATION_COMPONENT, key) as codec,
        open_endpoint(url) as link,
        counting("frame", link.name, count) as told,
    ):
        measured, cut_short = measure(
            Listener(link, codec.receiver, silence=PATIENT),
            codec,
            plan,
            lambda prober: told(prober.sent),
            say,
        )
    with put_off():
        write_link_log(measured, out)
        print_measured(measured, terminal())
        print(out)
    if cut_short:
        raise cut_short


@app.command("import")
def import_(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE",
            help="ping's output, irtt's JSON (.gz), a mahimahi trace, a table of netem's, a "
            "robot.tlog, a pcap.",
        ),
    ],
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="FILE", help="link.csv; of a table, link.toml."),
    ] = None,
    interval: Annotated[
        float | None,
        typer.Option(
            "--interval",
            min=0.001,
            max=10.0,
            metavar="S",
            help="Resample to ticks of so long [s]; else each measurement is a tick.",
        ),
    ] = None,
    back: Annotated[
        Path | None,
        typer.Option(
            "--back", metavar="FILE", help="Of a mahimahi trace: the measurements' direction."
        ),
    ] = None,
    clocks_within: ClocksOption = None,
    mean: Annotated[
        float | None, typer.Option("--mean", min=0.0, metavar="S", help="Of a netem table [s].")
    ] = None,
    spread: Annotated[
        float | None, typer.Option("--spread", min=0.0, metavar="S", help="Of a netem table [s].")
    ] = None,
) -> None:
    """Make link.csv of what others measured.

    FILE is known by what is in it.
    """
    table = read_table(file, mean, spread)
    if table is None:
        _refuse(file, "is no table of netem's", {"--mean": mean, "--spread": spread})
    else:
        others = {"--interval": interval, "--back": back, "--clocks-within": clocks_within}
        _refuse(file, "is a table of netem's", others)
    out = file_place("--out", out or Path("link.csv" if table is None else "link.toml"), file)
    if table is not None:
        late = Impairments(extra_delay=table)
        write_whole(out, link_toml(FittedLink(0, 0, late, late)))
    else:
        sizes = real_sizes(Sender(ROBOT_SYSTEM, ROBOT_COMPONENT))
        measured = read_link(file, How(sizes, interval, clocks_within, back))
        write_link_log(measured, out)
        print_measured(measured, terminal())
    print(out)


def _refuse(file: Path, what: str, options: Mapping[str, object]) -> None:
    """Those of them that were given."""
    for option, value in options.items():
        if value is not None:
            raise typer.BadParameter(f"{file} {what}, so {option} is not for it: leave it out")


@app.command("fit")
def fit(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A link.csv.")] = Path("link.csv"),
    out: Annotated[
        Path, typer.Option("--out", metavar="FILE", help="The link as a scenario file.")
    ] = Path("link.toml"),
    scenario: Annotated[
        str,
        typer.Option(
            "--scenario", metavar="NAME", help="What is to run on that link: the file holds it all."
        ),
    ] = "lab",
    interval: IntervalOption = 0.01,
    n: Annotated[
        int,
        typer.Option(
            "-n",
            min=0,
            max=UNKNOWN_DELAY - 1,
            help="The fixed delay that a run's link.csv leaves out.",
        ),
    ] = 0,
    m: Annotated[
        int,
        typer.Option("-m", min=0, max=UNKNOWN_DELAY - 1, help="The same of measurements."),
    ] = 0,
    late: Annotated[
        float,
        typer.Option(
            min=0.0, max=0.5, help="The share of frames that may come too late to be played out."
        ),
    ] = 0.01,
    figure: Annotated[
        Path | None,
        typer.Option("--figure", metavar="FILE", help="A picture: PNG, PDF, SVG and others."),
    ] = None,
    width: WidthOption = "two",
) -> None:
    """Fit a [link] table to link.csv, suggest bounds.

    How well it does is told; so is what each bound of a play-out would cost.
    """
    if figure is not None:
        require(DRAWING)
        picture_place(figure, "--figure")
    file_place("--out", out, file)
    on = load(scenario, {"sample_time": interval})
    found = fit_link(read_measured(file, interval, (n, m)), late)
    fitted = scenario_toml(on, found.link)
    write_whole(out, fitted)
    console = terminal()
    console.print(fit_table(found))
    law = station_config(on).law
    margin = delay_margin(law, interval) if isinstance(law, PolarLaw) else None
    console.print(choices_table(found, margin))
    for line in suggestions(found, out, replaying(scenario, file, (n, m), interval)):
        console.print(line, highlight=False)
    print(out)
    if figure is not None:
        save(draw_fit(found, width), figure)
        print(figure)
