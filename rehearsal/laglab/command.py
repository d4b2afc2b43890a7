"""The ``laglab`` command."""

import sys

import typer

from laglab.commands import (
    bench,
    compare,
    consistency,
    errata,
    fmu,
    protocol,
    replay,
    run,
    scenario,
    scenarios,
    serial,
    sides,
)
from laglab.errors import LaglabError, RunError, ScenarioError
from laglab.run.processes import SIDE_ERRORS
from laglab_gateway import RobotSilentError, StationSilentError
from laglab_protocol import FarEndGoneError, FarEndStalledError
from laglab_station import StationError

app = typer.Typer(
    help="A rehearsal rig for robots controlled across a network.",
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    add_completion=False,
)
app.command("run")(run.run)
app.command("replay")(replay.replay)
app.command("scenarios")(scenarios.scenarios)
app.command("scenario")(scenario.scenario)
app.command("compare")(compare.compare)
app.command("consistency")(consistency.consistency)
app.command("errata")(errata.errata)
app.command("gateway")(sides.gateway)
app.command("controller")(sides.controller)
app.command("serial")(serial.serial)
app.add_typer(bench.app, name="bench")
app.add_typer(fmu.app, name="fmu")
app.add_typer(protocol.app, name="protocol")
app.command("conform")(protocol.conform)

LINK_LOST = (
    StationError,
    StationSilentError,
    RobotSilentError,
    FarEndGoneError,
    FarEndStalledError,
)
"""What ends a run that had begun; the other errors of a side are the user's to mend."""


def main(arguments: list[str] | None = None) -> None:
    """Run one command; whatever the user did wrong is one line on standard error."""
    sys.exit(_exit_code(arguments))


def _exit_code(arguments: list[str] | None) -> int:
    try:
        code = app(arguments, standalone_mode=False)
    except typer.TyperException as error:
        return _say(error.format_message(), error.exit_code)
    except LaglabError as error:
        return _say(str(error), error.exit_code)
    except LINK_LOST as error:
        return _say(str(error), RunError.exit_code)
    except SIDE_ERRORS as error:
        return _say(str(error), ScenarioError.exit_code)
    except (typer.Abort, KeyboardInterrupt):
        return _say("interrupted", 130)
    return int(code or 0)


def _say(text: str, exit_code: int) -> int:
    print(f"laglab: {' '.join(text.split())}", file=sys.stderr)
    return exit_code
