"""Measured at other times than a run's ticks: brought to them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from laglab.link.measured import Array, Flags, Flow, MeasuredLink


def known_everywhere(delay: Array, lost: Flags) -> Array:
    """Delays of all frames but the lost ones: where one came and its delay is not known (NaN), it
    is that of the nearest before it, or else after it."""
    known = np.flatnonzero(~np.isnan(delay))
    if not len(known):
        return np.where(lost, np.nan, 0.0)
    nearest = np.searchsorted(known, np.arange(len(delay)), side="right") - 1
    filled = delay[known[np.maximum(nearest, 0)]]
    return np.where(lost, np.nan, filled)


def resampled(measured: MeasuredLink, interval: float) -> MeasuredLink:
    """A frame every `interval` [s]: between two measurements the delay goes in a straight line, and
    what is nearer to a lost one is lost."""
    notes = measured.notes
    if measured.interval > 1.5 * interval:
        notes = (
            *notes,
            f"Measured every {measured.interval:.3g} s, a tick is {interval:g} s: what happens "
            "between two measurements is not known, and losses come in steps of that length.",
        )
    return replace(
        measured,
        command=_at_ticks(measured.command, measured.interval, interval),
        measurement=_at_ticks(measured.measurement, measured.interval, interval),
        interval=interval,
        notes=notes,
    )


def ticks_in(measured: MeasuredLink, interval: float) -> float:
    """How many ticks it is resampled to, by the longer direction."""
    spans = [np.ptp(flow.sent) for _, flow in measured.flows if len(flow.sent)]
    return float(max(spans, default=0.0) + measured.interval) / interval


def _at_ticks(flow: Flow, before: float, interval: float) -> Flow:
    if not len(flow.sent):
        return flow
    order = np.argsort(flow.sent, kind="stable")
    sent, delay = flow.sent[order], flow.delay[order]
    count = max(1, round((sent[-1] - sent[0] + before) / interval))
    ticks = interval * np.arange(count)
    middles = 0.5 * (sent[1:] + sent[:-1]) - sent[0]
    lost = np.isnan(delay)[np.searchsorted(middles, ticks)]
    came = ~np.isnan(delay)
    if not came.any():
        return replace(flow, sent=ticks, delay=np.full(count, np.nan))
    between = np.interp(ticks, sent[came] - sent[0], delay[came])
    return replace(flow, sent=ticks, delay=np.where(lost, np.nan, between))
