"""A fit as a picture: when each frame came and which did not; how delays are spread."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from laglab.link.fitting import Fit
from laglab.results.figures.style import (
    BLACK,
    BLUE,
    GREY,
    INCHES,
    RED,
    Width,
    legend,
    printed,
    sheet,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from laglab.link.measured import Array, Flow

HEIGHT = 3.4
"""[inch]"""
MANY = 2000
"""More dots than that are drawn as pixels even in a vector file."""


def draw_fit(fit: Fit, width: Width = "two") -> Figure:
    """Commands at the left, measurements at the right."""
    with printed():
        figure = sheet(INCHES[width], HEIGHT)
        panels = figure.subplots(2, 2, squeeze=False)
        told = zip(fit.measured.flows, fit.made.flows, fit.bounds.bounds, strict=True)
        for column, ((name, flow), (_, made), bound) in enumerate(told):
            played = 1e3 * bound * fit.measured.interval
            _draw_delays(panels[0, column], flow, played)
            _draw_shares(panels[1, column], flow, made, played)
            panels[0, column].set_title(f"{name}s", loc="right")
        for axes in panels[:, 0]:
            legend(axes)
        panels[0, 0].set_ylabel("delay [ms]")
        panels[1, 0].set_ylabel("share within the delay")
    return figure


def _draw_delays(axes: Axes, flow: Flow, played: float) -> None:
    came = ~flow.lost
    top = 1.15 * max(float(1e3 * flow.delivered.max(initial=0.0)), played, 1e-3)
    axes.plot(
        flow.sent[came],
        1e3 * flow.delay[came],
        ".",
        color=BLUE,
        markersize=1.6,
        rasterized=len(flow.sent) > MANY,
        label="came",
    )
    if flow.lost.any():
        height = np.full(int(flow.lost.sum()), top)
        axes.plot(flow.sent[flow.lost], height, "x", color=RED, markersize=2.6, label="lost")
    axes.axhline(played, color=GREY, linestyle=":", linewidth=0.8, label="played out")
    axes.set_ylim(0.0, 1.1 * top)
    axes.set_xlabel("time [s]")


def _draw_shares(axes: Axes, flow: Flow, made: Flow, played: float) -> None:
    _draw_share(axes, flow.delivered, BLACK, "-", "measured")
    _draw_share(axes, made.delivered, BLUE, (0, (3, 1)), "fitted")
    axes.axvline(played, color=GREY, linestyle=":", linewidth=0.8, label="played out")
    axes.set_ylim(0.0, 1.02)
    axes.set_xlabel("delay [ms]")


def _draw_share(
    axes: Axes, delays: Array, color: str, style: str | tuple[int, tuple[int, ...]], name: str
) -> None:
    shares = np.linspace(0.0, 1.0, 501)
    if len(delays):
        at = 1e3 * np.quantile(delays, shares)
        axes.plot(at, shares, color=color, linestyle=style, label=name)
