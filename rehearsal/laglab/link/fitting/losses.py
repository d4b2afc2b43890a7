"""Losses: each by itself, or in bursts.

Gilbert's chain has two states; in the good one all frames come, in the bad one a share is lost. Its
three numbers follow from how often one frame, two and three in a row are lost (E. N. Gilbert,
"Capacity of a burst-noise channel", 1960).
"""

import math
from typing import NamedTuple

import numpy as np

from laglab.link.measured import Flags
from laglab_gateway import Burst

SURE = 3.0
"""[standard deviations] Losses that follow each other more often than by chance come in bursts."""
ENOUGH = 100
"""Losses: fewer do not tell whether frames get through within a burst."""
LEAST_THROUGH = 0.02
"""A smaller share that gets through in the bad state counts as none."""


class Losses(NamedTuple):
    """As `Impairments` has them."""

    loss: float = 0.0
    burst: Burst | None = None


def fit_losses(lost: Flags) -> Losses:
    """A model that loses as many frames, and as many in a row."""
    share = float(lost.mean()) if len(lost) else 0.0
    if not 0 < share < 1:
        return Losses(share)
    after_one = lost[1:][lost[:-1]]
    again = float(after_one.mean()) if len(after_one) else 0.0
    by_chance = math.sqrt(share * (1 - share) / max(len(after_one), 1))
    if again - share < SURE * by_chance:
        return Losses(_rounded(share))
    return Losses(burst=_with_some_through(lost, share, again) or _all_lost(share, again))


def _all_lost(share: float, again: float) -> Burst:
    """In the bad state nothing gets through: a burst's mean length is 1 / bad_to_good."""
    back = max(1 - again, 1e-6)
    return Burst(_rounded(share * back / (1 - share)), _rounded(back))


def _with_some_through(lost: Flags, share: float, again: float) -> Burst | None:
    """Gilbert's three numbers; None where the losses do not tell them."""
    if lost.sum() < ENOUGH:
        return None
    first, second, third = lost[:-2], lost[1:-1], lost[2:]
    around = int(np.sum(first & third))
    if not around:
        return None
    a, b, c = share, again, float(np.sum(first & second & third)) / around
    below = 2 * a * c - b * (a + c)
    stays = (a * c - b * b) / below if below else 0.0
    if not 0 < stays < 1:
        return None
    loss_bad = b / stays
    back = 1 - stays
    if not share < loss_bad < 1 - LEAST_THROUGH:
        return None
    return Burst(_rounded(a * back / (loss_bad - a)), _rounded(back), 0.0, _rounded(loss_bad))


def _rounded(probability: float) -> float:
    return float(f"{min(max(probability, 0.0), 1.0):.4g}")
