"""``laglab soak``."""

from pathlib import Path
from typing import Annotated

import typer

from laglab.errors import PlaceError
from laglab.extras import REHEARSING, require
from laglab.files import folder_place
from laglab.progress import passing
from laglab.results.place import fresh
from laglab.soak import Soak, repeated, require_processes, summary_tables, verdict
from laglab.tables import terminal
from laglab_protocol import require_terminals

FAILED = 1
USUAL_MINUTES = 30.0
MOST_MINUTES = 60.0 * 24 * 365


def soak(
    minutes: Annotated[
        float | None,
        typer.Option(
            min=0.01,
            max=MOST_MINUTES,
            help=f"How long, {USUAL_MINUTES:g} if not told; the last turn is finished.",
        ),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, max=2**31 - 1, help="Of all that is drawn.")] = 1,
    turn: Annotated[
        int | None, typer.Option(min=1, metavar="N", help="Play the turn of this number alone.")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="For the report, and the turns that failed."),
    ] = None,
) -> None:
    """Try both sides in random situations, for hours.

    Scenarios, impairments, kills, restarts, strangers, over UDP and serial, signed and not; exit
    codes, files, memory, descriptors and processes are checked in every one.
    """
    require(REHEARSING)
    if turn is not None and minutes is not None:
        raise typer.BadParameter("--turn plays one turn to its end: leave --minutes out")
    require_terminals("soak")
    require_processes()

    def tell(lines: list[str]) -> None:
        for line in lines:
            print(line, flush=True)

    minutes = USUAL_MINUTES if minutes is None else minutes
    command = f"laglab soak --minutes {minutes:g} --seed {seed}"
    place = _place(out, turn)
    going = Soak(command if turn is None else repeated(seed, turn), seed, place, tell)
    try:
        if turn is None:
            with passing("soak", 60 * minutes) as passed:
                going.turns(60 * minutes, passed)
        else:
            going.turn(turn)
    finally:
        going.write()
    report = going.report()
    for table in summary_tables(report):
        terminal().print(table)
    tell([verdict(report), f"report in {place}"])
    raise typer.Exit(FAILED if report.tally.failed else 0)


def _place(out: Path | None, turn: int | None) -> Path:
    """An empty one for a soak; beside the report for a turn of it. Raises PlaceError."""
    if turn is not None:
        return folder_place("--out", (out or Path("runs", "soak")) / f"again-{turn}")
    if out is None:
        return fresh(Path("runs"), "soak")
    if theirs := [*out.glob("turn-*"), *out.glob("soak.*")]:
        raise PlaceError(f"--out {out}: {theirs[0].name} is there already: take another folder")
    return folder_place("--out", out)
