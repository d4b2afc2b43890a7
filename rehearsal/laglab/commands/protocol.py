"""`laglab protocol` and `laglab conform`."""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer

from laglab.commands.group import group
from laglab.commands.options import KeyOption
from laglab.files import file_place, folder_place, write_whole
from laglab.progress import status
from laglab.selftest import self_test as parsers_tested
from laglab_conformance import Pace, Scope, Side, Waits
from laglab_conformance import conform as test_conformance
from laglab_protocol import make_key, read_key
from laglab_protocol.dialect.lint import lint as find_faults
from laglab_protocol.dialect.mavgen import (
    GENERATED,
    LANGUAGES,
    dialect_path,
    generate_into,
    place_in_pymavlink,
)

app = group("The dialect, for those who write the other side.")

DialectOption = Annotated[
    Path | None,
    typer.Option("--dialect", metavar="FILE", help="Another dialect than laglab's own."),
]


@app.command()
def lint(
    file: Annotated[Path | None, typer.Argument(metavar="FILE", help="A dialect's XML.")] = None,
) -> None:
    """Refuse what mavgen lets through, in FILE or in our dialect."""
    xml = file or dialect_path()
    findings = find_faults(xml)
    for finding in findings:
        print(f"{xml.name}: {finding.where}: {finding.what}")
    if findings:
        raise typer.Exit(1)
    print(f"{xml.name}: nothing to complain of")


@app.command()
def generate(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Where the code goes.")],
    lang: Annotated[str, typer.Option(metavar="NAME", help=f"{', '.join(LANGUAGES)}.")] = "C",
    dialect: DialectOption = None,
) -> None:
    """Generate code from the dialect.

    For firmware (C), programs (Python3), or as a dissector for Wireshark (WLua).
    """
    print(generate_into(lang, folder_place("DIR", directory), dialect))


@app.command()
def install() -> None:
    """Teach the pymavlink installed here the dialect.

    From then on its tools know it: mavlogdump.py --dialect laglab robot.tlog.
    """
    path = file_place("pymavlink:", place_in_pymavlink())
    write_whole(path, GENERATED.read_bytes())
    print(path)


@app.command()
def keygen(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Must not exist yet.")],
) -> None:
    """Make a key for signing, readable by its owner only."""
    make_key(file)
    print(file)


def conform(
    url: Annotated[
        str | None, typer.Argument(metavar="URL", help="Where the other side answers.")
    ] = None,
    side: Annotated[Side | None, typer.Option(help="What answers there.")] = None,
    junit: Annotated[
        Path | None, typer.Option("--junit", metavar="FILE", help="Also write JUnit XML.")
    ] = None,
    key: KeyOption = None,
    pace: Annotated[
        Pace | None,
        typer.Option(help="Whether a robot waits for each command, or has a clock of its own."),
    ] = None,
    wait: Annotated[
        float | None,
        typer.Option(
            metavar="SECONDS",
            min=0.1,
            help=f"How long a reaction may take, {Waits().react:g} if not told: longer for a robot "
            "behind long delays.",
        ),
    ] = None,
    silent: Annotated[
        bool,
        typer.Option(
            "--silent",
            help="Only whether a robot in lock-step gives up a silent station, which ends its run.",
        ),
    ] = False,
    self_test: Annotated[
        bool,
        typer.Option(
            "--self-test",
            help="Nothing but how robots do that read by pymavlink, by mavgen's C, by libmav.",
        ),
    ] = False,
) -> None:
    """Test whether what answers at URL speaks the protocol.

    The robot, or the controller, whose run it ends.
    """
    if self_test:
        if url or side or junit or key or pace or wait or silent:
            raise typer.BadParameter("--self-test has robots of its own: say nothing else with it")
        _self_test()
        return
    if url is None or side is None:
        raise typer.BadParameter("say where the other side answers, URL, and what it is, --side")
    _refuse_contradictions(side, pace, silent)
    if key:
        read_key(key)
    if junit:
        file_place("--junit", junit)
    react = Waits().react if wait is None else wait
    waits = Waits(appear=max(Waits().appear, react), react=react)
    scope: Scope = "silence" if silent else "all"
    with status() as tell:
        how = pace or "lockstep"
        report = test_conformance(url, side, key, waits, how, scope, _announcing(tell))
    if report.is_whole or report.tried:
        print(report.table())
    if not report.is_whole:
        raise KeyboardInterrupt
    if junit:
        write_whole(junit, report.junit())
    raise typer.Exit(0 if report.conforms else 1)


def _self_test() -> None:
    with status() as tell:
        tell("robots that read by other people's parsers")
        tested = parsers_tested()
    print(tested.table())


def _refuse_contradictions(side: Side, pace: Pace | None, silent: bool) -> None:
    if side == "controller" and pace:
        raise typer.BadParameter("a controller keeps no pace of its own: leave --pace out")
    if silent and (side == "controller" or pace == "realtime"):
        raise typer.BadParameter("--silent is for a robot in lock-step, which alone gives up")


def _announcing(tell: Callable[[str], None]) -> Callable[[str], None]:
    """Passes progress on; the first, what is done at all, stays to be read."""
    said: list[str] = []

    def progress(step: str) -> None:
        if not said:
            print(step, file=sys.stderr, flush=True)
        said.append(step)
        tell(step)

    return progress
