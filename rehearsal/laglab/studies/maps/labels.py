"""How keys, values and estimates are spelled on a picture."""

from __future__ import annotations

import math
from collections.abc import Sequence

from laglab.studies.maps.measures import Interval

NAMES = {
    "link.command_delay": "command delay n [ticks]",
    "link.measurement_delay": "measurement delay m [ticks]",
    "estimator.initial_covariance": "P_0",
    "law.lambda": "gain λ [1/s]",
    "law.gamma": "gain γ [1/s]",
    "link.command.loss": "loss of commands",
    "link.measurement.loss": "loss of measurements",
    "link.command.extra_delay.mean": "jitter of commands, mean [s]",
    "link.measurement.extra_delay.mean": "jitter of measurements, mean [s]",
}
MOST_TICKS = 12
"""The most labels along one side."""


def key_label(key: str) -> str:
    """Of an axis."""
    return NAMES.get(key, key)


def value_label(value: object) -> str:
    """Of one value."""
    if isinstance(value, bool):
        return "on" if value else "off"
    return f"{value:g}" if isinstance(value, float) else str(value)


def panel_label(key: str | None, value: object) -> str:
    """Above a panel."""
    if key is None:
        return ""
    return str(value) if key == "estimator.kind" else f"{key_label(key)} = {value_label(value)}"


def tick_labels(values: Sequence[object]) -> tuple[list[int], list[str]]:
    """Places and texts, not more than fit."""
    step = -(-len(values) // MOST_TICKS)
    places = list(range(0, len(values), step))
    return places, [value_label(values[place]) for place in places]


def in_cell(estimate: Interval, share: bool) -> str:
    """The number, and under it what it lies between."""
    if math.isnan(estimate.centre):
        return "–"
    if share:
        low, high = (f"{100 * bound:.0f}" for bound in estimate[1:])
        return f"{100 * estimate.centre:.0f} %\n{low}–{high}"
    centre, low, high = (f"{value:.2g}" for value in estimate)
    return centre if low == high else f"{centre}\n{low}–{high}"
