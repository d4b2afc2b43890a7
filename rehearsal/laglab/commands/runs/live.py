"""`--live`: a page that follows the run, on any command that makes one."""

import webbrowser
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated

import typer

from laglab.extras import SEEING, require
from laglab.live import LivePage, live_page, place_of
from laglab.results.complete import Manner
from laglab.scenario import Scenario
from laglab.tables import say

LiveOption = Annotated[
    str | None,
    typer.Option(
        "--live",
        metavar="[[HOST:]PORT]",
        help="Follow the run in a browser, and stop it from there; on loopback, at a port from "
        "the system, unless told otherwise.",
    ),
]
OpenOption = Annotated[bool, typer.Option("--open", help="Open the live page in a browser.")]


@contextmanager
def shown_live(
    scenario: Scenario, manner: Manner, live: str | None, open_: bool
) -> Iterator[LivePage | None]:
    """The page, its address told; None where nobody asked for one. Raises LiveError."""
    if live is None and not open_:
        yield None
        return
    require(SEEING)
    origin = (
        f"Side: {manner.side}; over {manner.transport}; plant {manner.plant}; seed {scenario.seed}."
    )
    alone, measured = manner.side == "station", manner.plant != scenario.plant.called
    with live_page(scenario, place_of(live or "0"), origin, alone, measured) as page:
        if warning := page.warning:
            say(f"warning: {warning}")
        say(f"live at {page.address}")
        if open_:
            webbrowser.open(page.address)
        yield page
