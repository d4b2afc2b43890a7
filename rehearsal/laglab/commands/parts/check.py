"""``laglab check``."""

from typing import Annotated

import typer

from laglab.check import SHIPPED, CheckOrder, Kind, all_hold, checked_apart, findings_table
from laglab.errors import ScenarioError
from laglab.extras import STEPPING, require
from laglab.scenario import assignment
from laglab.tables import terminal

FAILED = 1
"""Exit code: a check does not hold, and nobody admits it."""


def check(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="`module:Class`, a plug-in's or a shipped name.")
    ],
    as_: Annotated[
        Kind | None,
        typer.Option("--as", help="What it is, where that cannot be seen by its methods."),
    ] = None,
    option: Annotated[
        list[str] | None,
        typer.Option(
            "--option", metavar="KEY=VALUE", help="What it is told besides; may be repeated."
        ),
    ] = None,
) -> None:
    """Check that a filter, law or plant keeps its interface.

    A row for each thing that can be wrong; exit code 1 when one does not hold.
    """
    try:
        dict(map(assignment, option or []))
    except ScenarioError as error:
        raise ScenarioError(str(error).replace("--set", "--option")) from None
    if name in SHIPPED["plant"] and as_ in (None, "plant"):
        require(STEPPING)
    kind, found = checked_apart(CheckOrder(name, as_, tuple(option or ())))
    terminal().print(findings_table(found), highlight=False)
    held = all_hold(found)
    article = "an" if kind == "estimator" else "a"
    verdict = "keeps" if held else "does not keep"
    print(f"{name} {verdict} the interface of {article} {kind}")
    raise typer.Exit(0 if held else FAILED)
