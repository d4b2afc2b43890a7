"""The whole of a fit."""

import math
from typing import NamedTuple

import numpy as np

from laglab.link.fitting.bounds import ROUNDING, Choice, delay_in_ticks, suggested
from laglab.link.fitting.delays import fit_delays
from laglab.link.fitting.goodness import distance, simulated
from laglab.link.fitting.losses import fit_losses
from laglab.link.link_table import FittedLink
from laglab.link.measured import Flow, MeasuredLink
from laglab_gateway import Impairments


class Fit(NamedTuple):
    """A link fitted to what was measured."""

    measured: MeasuredLink
    link: FittedLink
    made: MeasuredLink
    """What the fitted link makes of frames of the same size and rate."""
    distances: tuple[float, float]
    """Kolmogorov and Smirnov's, between the delays measured and made: commands, measurements."""
    usual: tuple[int, int]
    """The median delays [ticks]: n and m for a station without play-out."""
    bounds: Choice
    """What is suggested to play out by."""


def fit(measured: MeasuredLink, late: float) -> Fit:
    """The fixed delay is what the fastest frame took, in whole ticks; what is beyond it scatters.

    `late` is the share that may come after the bounds that are suggested.
    """
    interval = measured.interval
    (n, command), (m, measurement) = (_fitted(flow, interval) for _, flow in measured.flows)
    made = MeasuredLink(
        simulated(command, n * interval, measured.command, interval),
        simulated(measurement, m * interval, measured.measurement, interval),
        interval,
    )
    bounds = suggested(measured, late)
    link = FittedLink(n, m, command, measurement, bounds.bounds)
    told = zip(measured.flows, made.flows, strict=True)
    distances = [distance(was.delivered, now.delivered) for (_, was), (_, now) in told]
    usual = [_median(flow, interval) for _, flow in measured.flows]
    return Fit(measured, link, made, (distances[0], distances[1]), (usual[0], usual[1]), bounds)


def _fitted(flow: Flow, interval: float) -> tuple[int, Impairments]:
    if not len(flow.delivered):
        return 0, Impairments(loss=1.0 if len(flow.delay) else 0.0)
    fixed = math.floor(float(flow.delivered.min()) / interval + ROUNDING)
    losses = fit_losses(flow.lost)
    extra = np.maximum(flow.delay - fixed * interval, 0.0)
    return fixed, Impairments(fit_delays(extra), losses.loss, losses.burst)


def _median(flow: Flow, interval: float) -> int:
    ticks = delay_in_ticks(flow, interval)
    return int(np.median(ticks)) if len(ticks) else 0
