"""Panels over time: the pose, the estimate's error with what is claimed of it, the speeds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from laglab.results.figures.style import BLACK, BLUE, GREY, ORANGE, PALE, SKY, Line, line
from laglab.results.numbers import goal_errors

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from laglab.results.figures.shown import Shown

Array = NDArray[np.float64]

COMPONENTS = ("x [m]", "y [m]", "θ [rad]")
ERRORS = ("x error\n[m]", "y error\n[m]", "θ error\n[rad]")
LESS_MEASURED = ("x less\nmeasured [m]", "y less\nmeasured [m]", "θ less\nmeasured [rad]")
"""The same where the true pose is not known."""
SPEEDS = {"v": "v [m/s]", "omega": "ω [rad/s]"}
ROOM = 1.2
"""How many times as large as what is in it a panel is."""
MOST_SHOWN = 1e9
"""An estimate beyond that is of no use, nor is an axis that long."""
ROUNDING = 1e-9
"""An error below that is none, and no axis is as short."""
MARKERS = 9
"""How many are on a line, so that it is known in grey too."""


def draw_component(axes: Axes, shown: Shown, i: int) -> None:
    """x, y or θ over time: measured, true, estimated, and the goal's."""
    draw_measured(axes, shown.time, shown.measured[:, i])
    if not shown.is_measured:
        axes.plot(shown.time, shown.pose[:, i], color=BLACK, linewidth=1.1, label="true")
    if shown.is_estimated:
        estimate = shown.estimate[:, i]
        axes.plot(shown.time, estimate, color=BLUE, linestyle=(0, (3, 1)), label="estimated")
    wanted, name = shown.wanted[:, i], "goal" if shown.target.path is None else "path"
    axes.plot(shown.time, wanted, color=GREY, linestyle=":", linewidth=0.8, label=name)
    around(axes, shown.pose[:, i], float(wanted.min()), float(wanted.max()))
    axes.set_ylabel(COMPONENTS[i])


def draw_distance(axes: Axes, shown: Shown) -> None:
    """How far the robot is from where its path wanted it."""
    distance, _ = goal_errors(shown.pose, shown.wanted)
    axes.plot(shown.time, distance, color=BLACK, linewidth=0.9)
    axes.set_ylabel("to the path\n[m]")
    around(axes, distance, 0.0)


def draw_measured(axes: Axes, x: ArrayLike, y: ArrayLike) -> None:
    """A pale dot each, behind all else."""
    draw_dots(axes, x, y, "measured")


def draw_dots(axes: Axes, x: ArrayLike, y: ArrayLike, name: str) -> None:
    """Drawn as pixels even in a vector file: there may be thousands."""
    axes.plot(
        x,
        y,
        ".",
        color=GREY,
        markersize=1.0,
        alpha=0.5,
        rasterized=True,
        zorder=1.5,
        label=name,
    )


def around(axes: Axes, values: Array, *others: float) -> None:
    """Limits that all of these are in, whatever else is drawn there."""
    known = np.append(values[np.isfinite(values)], others)
    low, high = float(known.min()), float(known.max())
    room = (ROOM - 1) / 2 * (high - low) or 0.05
    axes.set_ylim(low - room, high + room)


def draw_error(axes: Axes, shown: Shown, i: int) -> None:
    """The estimate less the pose, between ±2σ of the covariance that the station claims."""
    error, two_sigma = shown.error[:, i], 2 * shown.claimed[:, i]
    axes.fill_between(
        shown.claimed_time,
        -two_sigma,
        two_sigma,
        facecolor=SKY,
        alpha=0.35,
        linewidth=0,
        label="±2σ claimed",
        zorder=1,
    )
    for edge in (-two_sigma, two_sigma):
        axes.plot(shown.claimed_time, edge, color=BLUE, linewidth=0.4, zorder=1.1)
    if shown.is_measured:
        draw_dots(axes, shown.time, error, "estimate less measurement")
    else:
        axes.plot(shown.time, error, color=BLACK, linewidth=0.7, label="error", zorder=2)
    axes.axhline(0.0, color=GREY, linewidth=0.5, linestyle=":")
    axes.set_ylabel(error_label(i, shown.is_measured))
    symmetric(axes, [error], two_sigma)


def error_label(i: int, measured: bool) -> str:
    """Of the estimate's error in x, y or θ; `measured`: the true pose is not known."""
    return (LESS_MEASURED if measured else ERRORS)[i]


def symmetric(axes: Axes, errors: list[Array], two_sigma: Array) -> None:
    """Limits that all errors are in, and what is claimed nearly always: a claim may be wide for a
    moment."""
    known = np.concatenate(errors)
    known = np.abs(known[np.isfinite(known)])
    claims = two_sigma[np.isfinite(two_sigma)]
    largest = max(
        float(known.max(initial=0.0)),
        float(np.quantile(claims, 0.95)) if len(claims) else 0.0,
    )
    half = ROOM * min(largest, MOST_SHOWN) if largest > ROUNDING else 1e-3
    axes.set_ylim(-half, half)


def draw_shadows(axes: Axes, shown: Shown, i: int) -> None:
    """The errors of the estimator in the loop and of those that shadowed it."""
    names = [shown.estimator, *shown.scenario.estimator.compare]
    errors = [shown.error, *map(shown.shadow_error, names[1:])]
    for number, (name, error) in enumerate(zip(names, errors, strict=True)):
        marked(axes, shown.time, error[:, i], line(number), number, name)
    axes.axhline(0.0, color=GREY, linewidth=0.5, linestyle=":")
    axes.set_ylabel(error_label(i, shown.is_measured))
    symmetric(axes, [error[:, i] for error in errors], np.empty(0))


def marked(axes: Axes, time: Array, values: Array, look: Line, number: int, name: str) -> None:
    """A line with a marker now and then, at other times than the lines before it."""
    every = max(1, len(time) // MARKERS)
    axes.plot(
        time,
        values,
        color=look.color,
        linestyle=look.linestyle,
        marker=look.marker,
        markersize=2.6,
        markerfacecolor="white",
        markeredgewidth=0.6,
        markevery=(number * every // 4 % every, every),
        label=name,
    )


def draw_speed(axes: Axes, shown: Shown, name: str) -> None:
    """v or ω: the commands sent, and what was applied."""
    axes.plot(
        shown.time,
        shown.trace[name],
        color=BLUE,
        drawstyle="steps-post",
        label="applied",
    )
    axes.plot(
        shown.time,
        shown.trace[f"{name}_sent"],
        color=ORANGE,
        linestyle=(0, (2.5, 1)),
        linewidth=0.8,
        drawstyle="steps-post",
        label="sent",
    )
    axes.axhline(0.0, color=PALE, linewidth=0.6)
    axes.set_ylabel(SPEEDS[name])
