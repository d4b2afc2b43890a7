"""The ``laglab`` command."""

import signal
import sys
from typing import Annotated

import typer

from laglab import __version__
from laglab.commands import bench, link, protocol
from laglab.commands.group import alone, group
from laglab.commands.parts import check, estimators, fmu, new, plant, scenario, scenarios
from laglab.commands.results import animate, compare, export, figure, report
from laglab.commands.runs import replay, run, serial, sides, soak
from laglab.commands.studies import (
    consistency,
    errata,
    maps,
    reproduce,
    rivals,
    sweep,
    trust,
)
from laglab.errors import LaglabError, RunError, ScenarioError
from laglab.interrupts import INTERRUPTED, on_interrupt
from laglab.live import spelled_out
from laglab.output import guarded
from laglab.runs.errors import CUT_SHORT, SIDE_ERRORS


def _tell_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"laglab {__version__}")
        raise typer.Exit


VersionOption = Annotated[
    bool,
    typer.Option(
        "--version", callback=_tell_version, is_eager=True, help="Say which laglab this is."
    ),
]


def laglab(context: typer.Context, version: VersionOption = False) -> None:
    """What stands before a command."""
    del version  # told already
    alone(context)


app = group(
    "A rehearsal rig for robots controlled across a network.", callback=laglab, completion=True
)
app.command("run")(run.run)
app.command("replay")(replay.replay)
app.command("scenarios")(scenarios.scenarios)
app.command("estimators")(estimators.estimators)
app.command("laws")(estimators.laws)
app.command("plants")(estimators.plants)
app.command("check")(check.check)
app.command("new")(new.new)
app.command("scenario")(scenario.scenario)
app.command("figure")(figure.figure)
app.command("report")(report.report)
app.command("compare")(compare.compare)
app.command("export")(export.export)
app.command("animate")(animate.animate)
app.command("consistency")(consistency.consistency)
app.command("trust")(trust.trust)
app.command("rivals")(rivals.rivals)
app.command("soak")(soak.soak)
app.command("map")(maps.map_study)
app.command("reproduce")(reproduce.reproduce)
app.command("errata")(errata.errata)
app.command("sweep")(sweep.sweep)
app.command("gateway")(sides.gateway)
app.command("controller")(sides.controller)
app.command("serial")(serial.serial)
app.add_typer(bench.app, name="bench")
app.add_typer(fmu.app, name="fmu")
app.add_typer(plant.app, name="plant")
app.add_typer(link.app, name="link")
app.add_typer(protocol.app, name="protocol")
app.command("conform")(protocol.conform)


def main(arguments: list[str] | None = None) -> None:
    """Run one command; whatever the user did wrong is one line on standard error."""
    sys.exit(run_command(arguments))


def run_command(arguments: list[str] | None) -> int:
    """The exit code of one command. SIGTERM and a terminal that closes end it as Ctrl-C does."""
    return guarded(lambda: _exit_code(arguments))


def _exit_code(arguments: list[str] | None) -> int:
    try:
        on_interrupt(signal.default_int_handler)
        code = int(
            app(
                spelled_out(sys.argv[1:] if arguments is None else arguments),
                prog_name="laglab",
                standalone_mode=False,
            )
            or 0
        )
    except typer.TyperException as error:
        return _say(error.format_message(), error.exit_code)
    except LaglabError as error:
        return _say(str(error), error.exit_code)
    except CUT_SHORT as error:
        return _say(str(error), RunError.exit_code)
    except SIDE_ERRORS as error:
        return _say(str(error), ScenarioError.exit_code)
    except OSError as error:
        return _say(_of_the_system(error), RunError.exit_code)
    except (typer.Abort, KeyboardInterrupt):
        code = INTERRUPTED
    return _say("interrupted", code) if code == INTERRUPTED else code


def _of_the_system(error: OSError) -> str:
    """What a disk or a library said, where nobody had a better word for it."""
    return f"{error.filename}: {error.strerror}" if error.filename else str(error)


def _say(text: str, exit_code: int) -> int:
    print(f"laglab: {' '.join(text.split())}", file=sys.stderr)
    return exit_code
