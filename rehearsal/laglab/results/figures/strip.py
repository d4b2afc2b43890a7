"""The link strip: when everything came, what did not, and what followed from it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from laglab.results.figures.marks import time_axis
from laglab.results.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    legend,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from laglab.results.figures.shown import Shown
    from laglab_gateway import Direction

CAUSES = {
    "lost": ("x", RED),
    "burst": ("|", BLACK),
    "outage": ("_", GREY),
    "queue-full": ("s", BLUE),
    "corrupted": ("D", PURPLE),
    "late": ("<", ORANGE),
    "stale": ("v", ORANGE),
    "out of limits": ("^", GREEN),
    "not finite": ("P", SKY),
    "incomplete": ("+", BLACK),
}
"""How a message that was lost or refused is marked."""
LANE = 0.16
"""The height of a lane of marks, as a share of that of the delays."""


def draw_delays(axes: Axes, shown: Shown, direction: Direction, bottom: bool = True) -> None:
    """A dot for each message that came, as high as its delay; above them a lane for each cause
    for which others did not."""
    view = shown.link.directions[direction]
    time, n = view.time / shown.clock.seconds, configured(shown, direction)
    axes.plot(time, view.delay, ".", color=BLUE, markersize=1.6, rasterized=len(time) > 2000)
    axes.axhline(n, color=GREY, linewidth=0.6, linestyle=":")
    top = 1.15 * max(float(view.delay.max(initial=0.0)), n, 1.0)
    lanes = {cause: times for cause, times in view.lost.items() if len(times)}
    for number, (cause, times) in enumerate(lanes.items()):
        height = top * (1 + LANE * (number + 0.6))
        marker, color = CAUSES.get(cause, ("1", BLACK))
        axes.plot(
            times / shown.clock.seconds,
            np.full(len(times), height),
            linestyle="none",
            marker=marker,
            markersize=2.6,
            markeredgewidth=0.7,
            color=color,
            label=f"{cause}: {view.counts[cause]}",
            rasterized=len(times) > 2000,
        )
    if not len(time):
        axes.text(0.5, 0.5, "none arrived", transform=axes.transAxes, ha="center", va="center")
    time_axis(axes, shown, bottom, view.outages)
    legend(axes)
    axes.set_ylim(0, top * (1 + LANE * (len(lanes) + 0.2)))
    axes.set_ylabel(f"{direction}\ndelay [ticks]")


def configured(shown: Shown, direction: Direction) -> int:
    """The delay that the link was told to have [ticks]."""
    link = shown.scenario.link
    return link.command_delay if direction == "command" else link.measurement_delay
