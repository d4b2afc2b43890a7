"""One HTML file of everything: what it shows, the scripts that move it, bokeh itself."""

import platform
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib.metadata import version
from importlib.resources import files

import jinja2
import msgspec
from bokeh.embed import components
from bokeh.model import Model
from bokeh.resources import Resources
from markupsafe import Markup
from msgspec import Struct

from laglab.results.link_view import Span
from laglab.results.report.axes import Axes
from laglab.results.report.plane import Plane, path_plot
from laglab.results.report.plots import Plots, time_plots
from laglab.results.report.sources import sources_of
from laglab.results.report.tables import Tables
from laglab.scenario import Scenario
from laglab.version import laglab_version

HERE = "laglab.results.report"
INSIDE = {
    "default-src": "'none'",
    "script-src": "'unsafe-inline'",
    "style-src": "'unsafe-inline'",
    "img-src": "data: blob:",
    "connect-src": "'none'",
}
"""What a page may load: nothing that is not in it."""


class ScriptSettings(Struct, frozen=True):
    """What the page's script is told of a run."""

    sample_time: float
    command_delay: int
    track: float


@dataclass(frozen=True)
class Panel:
    """One run of a page: its plots, and what is said of it."""

    name: str
    scenario: Scenario
    tables: Tables
    measured: bool
    timed: bool
    origin: str
    verdict: str = ""
    mood: str = ""
    notices: Sequence[str] = ()
    quiet: Sequence[Span] = ()
    """When nothing got through the link."""


@dataclass(frozen=True)
class Page:
    """What a page says besides its panels, and the scripts that move it."""

    title: str
    scripts: Sequence[str]
    """Their texts."""
    rows: Sequence[tuple[str, Sequence[str]]] = ()
    duration: float = 0.0
    live: bool = False
    controls: bool = False
    policy: Mapping[str, str] = field(default_factory=lambda: INSIDE)


def html(page: Page, panels: Sequence[Panel]) -> str:
    """The whole file."""
    axes, plane, high = Axes(), Plane(), 600 if len(panels) == 1 else 430
    drawn = [_plots(panel, number, axes, plane, high) for number, panel in enumerate(panels)]
    keyed: dict[str, Model] = {
        f"{i} {kind}": plot for i, plots in enumerate(drawn) for kind, plot in plots.items()
    }
    drawing, divs = components(dict(keyed))
    kinds = list(dict.fromkeys(kind for plots in drawn for kind in plots))
    own = text_of(HERE, "robot.js"), *page.scripts
    return template(HERE, "page.html").render(
        title=page.title,
        live=page.live,
        controls=page.controls,
        duration=page.duration,
        rows=page.rows,
        policy=policy_of(page.policy),
        style=Markup(text_of(HERE, "page.css")),
        runs=[_run(panel, i, divs, drawn[i]) for i, panel in enumerate(panels)],
        kinds=kinds,
        made_by=made_by(),
        settings=_settings(panels),
        scripts=Markup("\n".join([*bokeh_scripts(), drawing, *map(tagged, own)])),
    )


def _run(
    panel: Panel, number: int, divs: Mapping[str, str], kinds: Iterable[str]
) -> dict[str, object]:
    """What the template is told of a run."""
    return {
        "name": panel.name,
        "verdict": panel.verdict,
        "mood": panel.mood,
        "notices": panel.notices,
        "origin": panel.origin,
        "scenario": panel.scenario.to_toml(),
        "plots": {kind: Markup(divs[f"{number} {kind}"]) for kind in kinds},
    }


def _plots(panel: Panel, number: int, axes: Axes, plane: Plane, high: int) -> Plots:
    sources = sources_of(panel.tables, number)
    path = path_plot(sources, panel.scenario, plane, panel.measured, high)
    return {"path": path} | time_plots(
        sources, panel.scenario, axes, panel.timed, panel.quiet, panel.measured
    )


def _settings(panels: Sequence[Panel]) -> Markup:
    told = [
        ScriptSettings(
            panel.scenario.sample_time,
            panel.scenario.link.n,
            panel.scenario.plant.track,
        )
        for panel in panels
    ]
    return Markup(msgspec.json.encode({"runs": told}).decode())


def template(package: str, name: str) -> jinja2.Template:
    """A page's template; whatever is put into it is text, unless it is said to be markup."""
    return jinja2.Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True).from_string(
        text_of(package, name)
    )


def policy_of(allowed: Mapping[str, str]) -> str:
    """The content security policy, as a page states it."""
    return "; ".join(f"{what} {where}" for what, where in allowed.items())


def text_of(package: str, name: str) -> str:
    """The text of a file that lies beside our modules."""
    return (files(package) / name).read_text(encoding="utf-8")


def tagged(text: str) -> str:
    """The script, as a part of a page."""
    return f"<script>{text}</script>"


def bokeh_scripts() -> list[str]:
    """The scripts that bokeh's plots need."""
    inline = Resources(mode="inline", components=["bokeh"], log_level="error")
    return [tagged(text) for text in inline.js_raw]


def made_by() -> str:
    """With which versions a page was made."""
    packages = ", ".join(f"{name} {version(name)}" for name in ("numpy", "bokeh"))
    return f"Page by laglab {laglab_version()}, Python {platform.python_version()}, {packages}."
