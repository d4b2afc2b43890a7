"""How well a fit does: what it makes of as many frames, beside what was measured."""

import numpy as np

from laglab.link.measured import Array, Flow
from laglab_gateway import FateKind, Impairments, RandomFates

LEAST = 20_000
"""[frames] With fewer, chance decides."""
SEED = 1
DIGITS = 6
"""Of a delay in seconds: no clock tells finer, and a fit is written so."""


def simulated(link: Impairments, fixed: float, like: Flow, interval: float) -> Flow:
    """What such a link does to frames as a run sends them; `fixed` [s] is its fixed delay."""
    fates = RandomFates(link, (), np.random.default_rng(SEED))
    count = max(len(like.delay), LEAST)
    sent = interval * np.arange(count, dtype=np.float64)
    frame = bytes(like.size)
    delay = np.full(count, np.nan)
    for tick in range(count):
        fate = fates.of(tick, float(sent[tick]), frame)[0]
        if fate.kind is FateKind.DELIVERED:
            delay[tick] = fixed + fate.extra
    return Flow(sent, delay, like.size)


def distance(first: Array, second: Array) -> float:
    """The Kolmogorov-Smirnov distance of two samples [s], to DIGITS: a value that many share is
    the same in both; 0 where one is empty."""
    if not (len(first) and len(second)):
        return 0.0
    first, second = np.round(first, DIGITS), np.round(second, DIGITS)
    both = np.concatenate([first, second])
    shares = [
        np.searchsorted(np.sort(each), both, side="right") / len(each) for each in (first, second)
    ]
    return float(np.abs(shares[0] - shares[1]).max())
