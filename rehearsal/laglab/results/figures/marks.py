"""What is marked on every panel over time: outages, and when the robot or the estimate failed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from laglab.results.figures.style import BLACK, GREY, PALE, RED
from laglab.results.link_view import Span

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from laglab.results.figures.shown import Shown

ALARM, EMERGENCY, STOPPED, OUTAGE = "alarm", "emergency stop", "robot stops by itself", "outage"


def time_axis(
    axes: Axes, shown: Shown, bottom: bool = True, outages: Sequence[Span] | None = None
) -> None:
    """From the run's start to its end, with what happened marked; `bottom`: with its numbers.

    `outages` are those of both directions, if they are not given.
    """
    _mark_outages(axes, shown, shown.link.outages if outages is None else outages)
    for number, span in enumerate(shown.link.stopped):
        axes.axvspan(
            *_scaled(shown, span),
            facecolor="none",
            edgecolor=RED,
            hatch="....",
            linewidth=0.5,
            label=STOPPED if number == 0 else None,
            zorder=0.6,
        )
    _lines(axes, shown, shown.link.alarms, ALARM)
    _lines(axes, shown, shown.link.emergencies, EMERGENCY)
    axes.set_xlim(*shown.span)
    if bottom:
        axes.set_xlabel(shown.clock.label)
    else:
        axes.tick_params(labelbottom=False)


def _mark_outages(axes: Axes, shown: Shown, outages: Sequence[Span]) -> None:
    """A grey band each."""
    for number, span in enumerate(outages):
        axes.axvspan(
            *_scaled(shown, span),
            facecolor=PALE,
            edgecolor=GREY,
            hatch="////",
            linewidth=0.0,
            alpha=0.6,
            label=OUTAGE if number == 0 else None,
            zorder=0.5,
        )


def _lines(axes: Axes, shown: Shown, times: list[float], name: str) -> None:
    """With a triangle on top: so it is none of the curves, whatever their dashes."""
    style = (RED, (0, (1, 1.2)), 1.2) if name == ALARM else (BLACK, "-", 1.6)
    color, linestyle, width = style
    for number, time in enumerate(times):
        axes.axvline(
            time / shown.clock.seconds,
            color=color,
            linestyle=linestyle,
            linewidth=width,
            marker="v",
            markersize=4.0,
            markevery=[1],
            clip_on=False,
            label=name if number == 0 else None,
        )


def _scaled(shown: Shown, span: Span) -> tuple[float, float]:
    return span.start / shown.clock.seconds, span.end / shown.clock.seconds
