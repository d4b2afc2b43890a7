"""The plots of a page over time: all share one axis of time, each kind one axis of its own."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from bokeh.models import (
    CDSView,
    FactorRange,
    GroupFilter,
    HoverTool,
    InversionFilter,
    UnionFilter,
)
from bokeh.models.annotations import BoxAnnotation, Legend, Span, Title
from bokeh.models.renderers import GlyphRenderer
from bokeh.plotting import figure

from laglab.results.figures.style import BLUE, GREEN, ORANGE, RED, SKY
from laglab.results.link_view import Span as Time
from laglab.results.report.axes import Axes
from laglab.results.report.sources import Sources
from laglab.results.report.tables import LANES, marks
from laglab.scenario import Scenario

BLACK, GREY, PURPLE = "#222222", "#8c8c8c", "#9c4a86"
"""On a screen; the other colours are those of print."""
OTHERS = (PURPLE, GREEN, ORANGE, SKY)
DASHES = ("dashed", "dotdash", "dotted", "dashdot")
CAUSES = {
    "lost": ("x", RED),
    "burst": ("square", PURPLE),
    "outage": ("circle", GREY),
    "corrupted": ("triangle", GREEN),
    "queue-full": ("inverted_triangle", BLUE),
    "late": ("diamond", ORANGE),
}
"""Of a lost frame: its marker and colour."""
TOOLS = "xpan,box_zoom,xwheel_zoom,reset,save"
HEIGHT = 210
LEFT = 84
"""[pixel] Left of a plot: what its numbers need later too, as a live page's do."""


class Line(NamedTuple):
    """A column over time."""

    column: str
    label: str
    color: str
    dash: str = "solid"
    step: bool = False
    width: float = 1.6


Plots = dict[str, figure]
"""By kind, in the order in which they stand on the page."""


def time_plots(
    sources: Sources,
    scenario: Scenario,
    axes: Axes,
    timed: bool,
    quiet: Sequence[Time],
    measured: bool = False,
) -> Plots:
    """Errors, heading, speeds, link; how late ticks began, if they were `timed`; `quiet`: when
    nothing got through; `measured`: the true pose is not known."""
    off = "estimate less measurement" if measured else "estimate less robot"
    shadows = scenario.estimator.compare
    plots = {
        f"{axis} error": _error_plot(sources, axes, axis, f"{label} [{unit}]", off, shadows)
        for axis, label, unit in (("x", "x", "m"), ("y", "y", "m"), ("theta", "θ", "rad"))
    }
    plots["goal"] = _lines(
        sources,
        axes,
        f"to the {'goal' if scenario.path is None else 'path'}: ρ [m], heading [rad]",
        [
            Line("rho", "ρ", BLACK),
            Line("turn", "heading error", BLUE, "dashed"),
        ],
    )
    plots["v"] = _speed_plot(sources, axes, "v", "v [m/s]")
    plots["omega"] = _speed_plot(sources, axes, "omega", "ω [rad/s]")
    plots["delays"] = _delay_plot(sources, axes)
    plots["marks"] = _mark_plot(sources, axes)
    if timed:
        plots["timing"] = _timing_plot(sources, axes)
    curves = [each for plot in plots.values() for each in plot.renderers]
    for plot in plots.values():
        _mark_times(plot, sources, quiet)
    axes.follow(curves)
    return plots


def _plot(
    axes: Axes, title: str, values: FactorRange | None = None, height: int = HEIGHT
) -> figure:
    """An empty one; its title says its kind, whose axis of values it has unless one is given."""
    plot = figure(
        title=heading(title),
        height=height,
        sizing_mode="stretch_width",
        tools=TOOLS,
        active_drag="box_zoom",
        x_range=axes.time,
        y_range=axes.values(title) if values is None else values,
        min_border_left=LEFT,
        min_border_right=8,
        output_backend="canvas",
    )
    return dressed(plot)


def heading(text: str) -> Title:
    """The title of a plot."""
    return Title(text=text, text_font_size="13px", text_font_style="normal", text_color=BLACK)


def dressed(plot: figure) -> figure:
    """In the page's style."""
    plot.toolbar.logo = None
    plot.toolbar.autohide = True
    plot.xgrid.grid_line_color = plot.ygrid.grid_line_color = "#e8e8e8"
    plot.outline_line_color = "#cccccc"
    for axis in plot.axis:
        axis.axis_line_color = axis.major_tick_line_color = "#999999"
        axis.minor_tick_line_color = None
        axis.major_label_text_font_size = axis.axis_label_text_font_size = "11px"
    return plot


NAMES_IN_A_ROW = 3


def legend_above(plot: figure) -> None:
    """Out of the data's way, in rows that a narrow page has room for; a click hides a curve. None
    where nothing has a name."""
    if not plot.legend:
        return
    legend: Legend = plot.legend[0]
    legend.orientation = "horizontal"
    legend.ncols = min(NAMES_IN_A_ROW, len(legend.items))
    legend.location = "top_left"
    legend.click_policy = "hide"
    legend.label_text_font_size = "11px"
    legend.spacing = 10
    legend.border_line_color = None
    legend.background_fill_alpha = 0.0
    plot.add_layout(legend, "above")


def _lines(sources: Sources, axes: Axes, title: str, lines: Sequence[Line]) -> figure:
    plot = _plot(axes, title)
    for line in lines:
        _add(plot, sources, line)
    legend_above(plot)
    return plot


def _add(plot: figure, sources: Sources, line: Line) -> None:
    look: dict[str, Any] = {
        "source": sources.ticks,
        "color": line.color,
        "line_dash": line.dash,
        "line_width": line.width,
        **named(line.label, is_there(sources, line.column)),
    }
    drawn: GlyphRenderer[Any]
    if line.step:
        drawn = plot.step("time", line.column, mode="after", **look)
    else:
        drawn = plot.line("time", line.column, **look)
    tips = [("t", "@time{0.00} s"), (line.label, f"@{{{line.column}}}{{0.000}}")]
    plot.add_tools(HoverTool(renderers=[drawn], tooltips=tips, mode="vline", visible=False))


def _error_plot(
    sources: Sources, axes: Axes, axis: str, label: str, off: str, shadows: Sequence[str]
) -> figure:
    plot = _plot(axes, f"error of the estimate in {label}")
    if is_there(sources, f"{axis}_above"):
        plot.varea(
            "time",
            f"{axis}_below",
            f"{axis}_above",
            source=sources.ticks,
            color=BLUE,
            fill_alpha=0.16,
            legend_label="±2σ claimed",
        )
    _add(plot, sources, Line(f"{axis}_error", off, BLUE))
    for number, name in enumerate(shadows):
        color, dash = OTHERS[number % len(OTHERS)], DASHES[number % len(DASHES)]
        _add(plot, sources, Line(f"{axis}_error_{name}", name, color, dash, width=1.3))
    plot.add_layout(Span(dimension="width", location=0.0, line_color=GREY, line_width=1))
    legend_above(plot)
    return plot


def named(label: str, there: bool) -> dict[str, Any]:
    """What names a glyph in the legend, if there is anything of it."""
    return {"legend_label": label} if there else {}


def is_there(sources: Sources, column: str) -> bool:
    """Whether the run has any of it, or may still get some, as a page that is live."""
    there = np.asarray(sources.ticks.data[column], dtype=float)
    return not len(there) or bool(np.isfinite(there).any())


def _speed_plot(sources: Sources, axes: Axes, name: str, title: str) -> figure:
    sent = Line(f"{name}_sent", "sent", RED, "dashed", step=True, width=1.2)
    return _lines(sources, axes, title, [sent, Line(name, "in force", BLACK, step=True)])


def _delay_plot(sources: Sources, axes: Axes) -> figure:
    plot = _plot(axes, "delay of what came [ticks]")
    looks = (
        (sources.commands, "commands", RED, "circle"),
        (sources.measurements, "measurements", BLUE, "x"),
    )
    for source, label, color, marker in looks:
        drawn = plot.scatter(
            "time",
            "delay",
            source=source,
            marker=marker,
            size=4,
            color=color,
            fill_alpha=0.6,
            line_alpha=0.8,
            legend_label=label,
        )
        tips = [("came at", "@time{0.00} s"), ("stamp", "@tick"), ("delay", "@delay ticks")]
        plot.add_tools(HoverTool(renderers=[drawn], tooltips=tips, visible=False))
    legend_above(plot)
    return plot


def _mark_plot(sources: Sources, axes: Axes) -> figure:
    lanes = FactorRange(factors=list(LANES))
    plot = _plot(axes, "lost, by cause; refused; stops; alarms", lanes)
    to_come, marked = not len(sources.ticks.data["time"]), set(sources.marks.data["what"])
    if to_come:  # the legend draws what is there: one of each, at no time
        sources.marks.data = dict(marks([np.nan] * len(CAUSES), LANES[0], list(CAUSES)))
    for cause, (marker, color) in CAUSES.items():
        view = CDSView(filter=GroupFilter(column_name="what", group=cause))
        plot.scatter(
            "time",
            "lane",
            source=sources.marks,
            view=view,
            marker=marker,
            size=8,
            fill_alpha=0,
            line_color=color,
            **named(cause, to_come or cause in marked),
        )
    causes = [GroupFilter(column_name="what", group=cause) for cause in CAUSES]
    others = CDSView(filter=InversionFilter(operand=UnionFilter(operands=causes)))
    plot.scatter(
        "time", "lane", source=sources.marks, view=others, marker="diamond", size=9, color=BLACK
    )
    tips = [("t", "@time{0.00} s"), ("@lane", "@what")]
    plot.add_tools(HoverTool(tooltips=tips, visible=False))
    plot.ygrid.grid_line_color = None
    plot.xaxis.axis_label = "t [s]"
    legend_above(plot)
    return plot


def _timing_plot(sources: Sources, axes: Axes) -> figure:
    plot = _plot(axes, "ticks began late by [ms]", height=150)
    plot.scatter("time", "late", source=sources.timing, size=3, color=BLACK)
    return plot


def _mark_times(plot: figure, sources: Sources, quiet: Sequence[Time]) -> None:
    """When nothing got through, and the time that the page looks at."""
    for time in quiet:
        box = BoxAnnotation(left=time.start, right=time.end, level="underlay")
        box.update(fill_color="#bbbbbb", fill_alpha=0.3, line_color=None, hatch_pattern="/")
        box.update(hatch_color="#999999", hatch_alpha=0.4, hatch_scale=8, propagate_hover=True)
        plot.add_layout(box)
    plot.vspan("time", source=sources.now, color=GREEN, line_width=1.5)
