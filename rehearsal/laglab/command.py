"""The ``laglab`` command."""

import signal
import sys
from collections.abc import Iterable, Sequence
from importlib import import_module
from typing import Annotated

import typer

from laglab import __version__
from laglab.commands.group import alone, group
from laglab.errors import LaglabError, RunError, ScenarioError
from laglab.interrupts import INTERRUPTED
from laglab.last_resort import never_in_vain
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


COMMANDS = {
    "run": "runs.run:run",
    "replay": "runs.replay:replay",
    "scenarios": "parts.scenarios:scenarios",
    "estimators": "parts.estimators:estimators",
    "laws": "parts.estimators:laws",
    "plants": "parts.estimators:plants",
    "check": "parts.check:check",
    "new": "parts.new:new",
    "scenario": "parts.scenario:scenario",
    "figure": "results.figure:figure",
    "report": "results.report:report",
    "compare": "results.compare:compare",
    "export": "results.export:export",
    "animate": "results.animate:animate",
    "consistency": "studies.consistency:consistency",
    "trust": "studies.trust:trust",
    "rivals": "studies.rivals:rivals",
    "soak": "runs.soak:soak",
    "map": "studies.maps:map_study",
    "reproduce": "studies.reproduce:reproduce",
    "errata": "studies.errata:errata",
    "sweep": "studies.sweep:sweep",
    "gateway": "runs.sides:gateway",
    "controller": "runs.sides:controller",
    "serial": "runs.serial:serial",
    "bench": "bench:app",
    "fmu": "parts.fmu:app",
    "plant": "parts.plant:app",
    "link": "link:app",
    "protocol": "protocol:app",
    "conform": "protocol:conform",
}
"""By name where each stands in `laglab.commands`: a function, or a group of more."""


def app_of(names: Iterable[str] = COMMANDS) -> typer.Typer:
    """The command with these subcommands, in the order in which help lists them."""
    app = group(
        "A rehearsal rig for robots controlled across a network.", callback=laglab, completion=True
    )
    for name in names:
        module, _, attribute = COMMANDS[name].partition(":")
        command = getattr(import_module(f"laglab.commands.{module}"), attribute)
        if isinstance(command, typer.Typer):
            app.add_typer(command, name=name)
        else:
            app.command(name)(command)
    return app


def _asked_for(arguments: Sequence[str]) -> Iterable[str]:
    """Only the subcommand that is named: to import them all takes longer than many of them do."""
    name = arguments[0] if arguments else ""
    return [name] if name in COMMANDS else COMMANDS


def main(arguments: list[str] | None = None) -> None:
    """Run one command; whatever the user did wrong is one line on standard error."""
    sys.exit(run_command(arguments))


def run_command(arguments: list[str] | None) -> int:
    """The exit code of one command. SIGTERM and a terminal that closes end it as Ctrl-C does."""
    return guarded(lambda: _exit_code(arguments))


def _exit_code(arguments: list[str] | None) -> int:
    try:
        asked = spelled_out(sys.argv[1:] if arguments is None else arguments)
        app = app_of(_asked_for(asked))
        with never_in_vain(signal.default_int_handler):
            code = int(app(asked, prog_name="laglab", standalone_mode=False) or 0)
    except typer.TyperException as error:
        return _say(error.format_message().replace("Value error, ", ""), error.exit_code)
    except LaglabError as error:
        return _say(str(error), error.exit_code)
    except CUT_SHORT as error:
        return _say(str(error), RunError.exit_code)
    except SIDE_ERRORS as error:
        return _say(str(error), ScenarioError.exit_code)
    except OSError as error:
        return _say(_of_the_system(error), RunError.exit_code)
    except UnicodeEncodeError as error:
        return _say(
            f"{error.object!r} is no name in UTF-8: give it another", ScenarioError.exit_code
        )
    except (typer.Abort, KeyboardInterrupt):
        code = INTERRUPTED
    except RuntimeError as error:  # of Python 3.11, where one comes while a class is made
        if not isinstance(error.__cause__, KeyboardInterrupt):
            raise
        code = INTERRUPTED
    return _say("interrupted", code) if code == INTERRUPTED else code


def _of_the_system(error: OSError) -> str:
    """What a disk or a library said, where nobody had a better word for it."""
    return f"{error.filename}: {error.strerror}" if error.filename else str(error)


def _say(text: str, exit_code: int) -> int:
    print(f"laglab: {' '.join(text.split())}", file=sys.stderr)
    return exit_code
