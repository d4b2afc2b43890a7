"""The robot in the plane: its path, and where it is at the time that the page looks at."""

from bokeh.models import DataRange1d, HoverTool
from bokeh.plotting import figure

from laglab.results.figures.style import BLUE, GREEN, RED
from laglab.results.report.plots import (
    BLACK,
    GREY,
    LEFT,
    dressed,
    heading,
    is_there,
    legend_above,
    named,
)
from laglab.results.report.sources import Sources
from laglab.scenario import Scenario, Target


class Plane:
    """What the runs of a page share: one piece of the plane."""

    def __init__(self) -> None:
        self.x, self.y = DataRange1d(range_padding=0.1), DataRange1d(range_padding=0.1)


def path_plot(
    sources: Sources, scenario: Scenario, plane: Plane, measured: bool, height: int
) -> figure:
    """The path as it was, as estimated and as measured; over it the robot, twice the deviation
    claimed for where it is, and the way that the commands in flight will take it."""
    plot = figure(
        title=heading("path"),
        height=height,
        sizing_mode="stretch_width",
        tools="pan,box_zoom,wheel_zoom,reset,save",
        active_drag="pan",
        match_aspect=True,
        x_range=plane.x,
        y_range=plane.y,
        x_axis_label="x [m]",
        y_axis_label="y [m]",
        min_border_left=LEFT,
        min_border_right=8,
    )
    dressed(plot)
    _paths(plot, sources, measured)
    _mark_target(plot, scenario.target)
    _robot(plot, sources)
    legend_above(plot)
    return plot


def _paths(plot: figure, sources: Sources, measured: bool) -> None:
    ticks = sources.ticks
    plot.scatter(
        "x_meas", "y_meas", source=ticks, size=2, color=GREY, alpha=0.35, legend_label="measured"
    )
    if not measured:
        plot.line("x", "y", source=ticks, color=BLACK, line_width=1.8, legend_label="robot")
    path = plot.line(
        "x_est",
        "y_est",
        source=ticks,
        color=BLUE,
        line_dash="dashed",
        line_width=1.4,
        **named("estimated", is_there(sources, "x_est")),
    )
    tips = [("t", "@time{0.00} s"), ("x̂", "@x_est{0.000} m"), ("ŷ", "@y_est{0.000} m")]
    plot.add_tools(HoverTool(renderers=[path], tooltips=tips, visible=False))


def _robot(plot: figure, sources: Sources) -> None:
    """At the time that the page looks at."""
    plot.patch("x", "y", source=sources.robot, color=BLACK, fill_alpha=0.15, line_width=2)
    plot.patch(
        "x",
        "y",
        source=sources.ellipse,
        color=BLUE,
        fill_alpha=0.2,
        line_width=1.2,
        **named("2σ claimed", is_there(sources, "p_xx")),
    )
    flight = sources.flight
    plot.line("x", "y", source=flight, color=RED, line_width=2.5, legend_label="commands in flight")
    plot.scatter("x", "y", source=flight, color=RED, size=3.5)


def _mark_target(plot: figure, of: Target) -> None:
    """The goal, or the path that is to be followed."""
    x, y = of.outline().T.tolist()
    if of.path is None:
        plot.scatter(x, y, marker="star", size=15, color=GREEN, legend_label="goal")
    else:
        plot.line(x, y, color=GREEN, line_dash="dotted", line_width=2, legend_label="path")
