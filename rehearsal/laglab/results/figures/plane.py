"""The robot's way in the plane."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from laglab.results.figures.panels import draw_measured
from laglab.results.figures.style import BLACK, BLUE, GREEN, legend

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from laglab.results.figures.shown import Shown
    from laglab.scenario import Target

Array = NDArray[np.float64]

HEADINGS = 12
"""Arrows along a path."""
TURN = 0.1
"""[m/rad] As how long a way a turn on the spot counts."""
MARGIN = 0.08
SMALLEST = 0.05
"""[m] Half of what is shown at least: of a robot that stands, noise is not to fill the panel."""


def draw_path(axes: Axes, shown: Shown) -> None:
    """True, estimated and measured, from the start to the goal; arrows show the heading."""
    draw_measured(axes, *shown.measured[:, :2].T)
    if not shown.is_measured:
        axes.plot(*shown.pose[:, :2].T, color=BLACK, linewidth=1.1, label="true")
    if shown.is_estimated:
        axes.plot(*shown.estimate[:, :2].T, color=BLUE, linestyle=(0, (3, 1)), label="estimated")
    way = _way(shown)
    draw_headings(axes, way)
    mark_ends(axes, way, shown.target)
    fit(axes, [_framing(shown)], shown.target)
    legend(axes)


def _way(shown: Shown) -> Array:
    """Poses that are known, free of the sensor's noise where they can be."""
    smooth = shown.is_measured and shown.is_estimated
    poses = shown.estimate if smooth else shown.pose
    return poses[np.isfinite(poses).all(axis=1)]


def _framing(shown: Shown) -> Array:
    """What must be seen: an estimate may be anywhere, a measurement beside the robot."""
    return _way(shown) if shown.is_measured else shown.pose


def draw_headings(axes: Axes, poses: Array, color: str = BLACK) -> None:
    """Arrows at places that are equally far apart along the path."""
    if not len(poses):
        return
    x, y, theta = poses[along(poses, HEADINGS)].T
    axes.quiver(
        x,
        y,
        np.cos(theta),
        np.sin(theta),
        color=color,
        angles="xy",
        units="inches",
        scale_units="inches",
        scale=6.0,
        width=0.013,
        headwidth=5,
        headlength=5.5,
        headaxislength=5,
        zorder=3,
    )


def along(poses: Array, count: int) -> NDArray[np.intp]:
    """The rows of at most `count` poses, equally far apart along the path."""
    steps = np.hypot(*np.diff(poses[:, :2], axis=0).T)
    steps += TURN * np.abs(np.diff(poses[:, 2]))
    way = np.concatenate([[0.0], np.cumsum(steps)])
    wanted = np.linspace(0.0, way[-1], count)
    return np.unique(np.searchsorted(way, wanted).clip(0, len(poses) - 1))


def mark_ends(axes: Axes, poses: Array, target: Target) -> None:
    """Where it began, and where it is to go: to the goal or along its path."""
    if len(poses):
        axes.plot(*poses[0, :2], "o", color=BLACK, markerfacecolor="white", label="start", zorder=4)
    if target.path is not None:
        way = target.outline().T
        axes.plot(*way, color=GREEN, linewidth=3.5, alpha=0.35, label="path", zorder=1.4)
        return
    axes.plot(
        *target.goal[:2],
        "*",
        color=BLACK,
        markerfacecolor=GREEN,
        markeredgewidth=0.5,
        markersize=7,
        label="goal",
        zorder=4,
    )


def fit(axes: Axes, paths: list[Array], target: Target) -> None:
    """Equal axes around all of them, and where they were to lead."""
    places = np.concatenate([*(path[:, :2] for path in paths), target.outline()])
    places = places[np.isfinite(places).all(axis=1)]
    low, high = places.min(axis=0), places.max(axis=0)
    middle, half = (low + high) / 2, np.maximum((high - low) / 2 * (1 + 2 * MARGIN), SMALLEST)
    (left, down), (right, up) = middle - half, middle + half
    axes.set(xlabel="x [m]", ylabel="y [m]")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlim(left, right, auto=True)  # the aspect may widen one of them
    axes.set_ylim(down, up, auto=True)
