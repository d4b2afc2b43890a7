"""The live page: the report's plots, empty, and a script that fills them."""

import math
from dataclasses import replace

from laglab.live.messages import LiveOrder, Rows
from laglab.live.stream import tables_in
from laglab.results.link_view import Span
from laglab.results.report.page import INSIDE, Page, Panel, html, text_of
from laglab.scenario import Scenario

SELF = INSIDE | {"connect-src": "'self'"}
"""It also calls whoever served it."""
FOR_EVER = 1e9
"""[s] No page is looked at for so long."""


def page_html(scenario: Scenario, order: LiveOrder, controls: bool) -> str:
    """The whole page, of the scenario as ordered; with the buttons for who may press them."""
    panel = Panel(
        name=scenario.name,
        scenario=scenario,
        tables=tables_in(Rows(), scenario),
        measured=order.measured,
        timed=scenario.pace == "realtime" and not order.measured,
        origin=order.origin,
        quiet=announced(scenario),
    )
    page = Page(
        title=f"{scenario.name}, live: {scenario.gist}",
        scripts=[text_of("laglab.live", "live.js")],
        live=True,
        controls=controls,
        policy=SELF,
    )
    return html(page, [_without_shadows(panel)])


def announced(scenario: Scenario) -> list[Span]:
    """The outages that the scenario makes; others are seen as losses, once they have come."""
    last = scenario.duration if math.isfinite(scenario.duration) else FOR_EVER
    return [
        Span(event.at, min(event.at + event.duration, last))
        for event in scenario.link.event
        if event.link.loss >= 1 and event.at < last
    ]


def _without_shadows(panel: Panel) -> Panel:
    """Those estimate when the run is over."""
    estimator = panel.scenario.estimator.model_copy(update={"compare": ()})
    return replace(panel, scenario=panel.scenario.model_copy(update={"estimator": estimator}))
