"""Where a robot is put that somebody moves, and with which noise."""

import math
from collections.abc import Sequence

SEEDS, NEXT_SEED = 2**31, 7919
"""How many seeds there are, and how far apart those are that a run's placings take: neighbours are
likely to be other runs'."""

Pose = tuple[float, float, float]


def pose_asked(asked: Sequence[float], start: Sequence[float]) -> Pose:
    """What is asked for [m, m, rad]; NaN stands for the start pose's."""
    x, y, theta = (
        there if math.isnan(each) else each for each, there in zip(asked, start, strict=True)
    )
    return x, y, theta


def seed_of(seed: int, placed: int) -> int:
    """A seed that no placing before had; `placed` is 1 for the first placing."""
    return (seed + placed * NEXT_SEED) % SEEDS
