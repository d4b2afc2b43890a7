"""How late commands may come to a robot whose station does not predict.

Both loops of the law, linearised where they end: docs/theory.md, "The loop's delay margin".
"""

import cmath
import math
from typing import NamedTuple

from laglab_control.errors import ConfigError
from laglab_control.laws.polar import PolarLaw
from laglab_control.limits import Limit

LONGEST = 100_000
"""[ticks] No margin is looked for beyond this."""


class DelayMargin(NamedTuple):
    """The largest n + m [ticks] with which each loop of the law still settles; -1: not even 0."""

    approach: int
    """Of (4), on the way to the goal."""
    hold: int | None
    """Of the turn inside the goal tolerance; None without one."""


def delay_margin(law: PolarLaw, sample_time: float) -> DelayMargin:
    """Of the law's loops without limits, sampled every `sample_time` [s]. Raises ConfigError.

    With more delay than `approach` nothing settles by (4). A robot with a goal tolerance may still
    get inside it, and then turns by the other loop.
    """
    if not (limit := Limit(0, above=True)).allows(sample_time):
        raise ConfigError(f"sample_time must be {limit}, not {sample_time!r}")
    hold = None if law.goal_tolerance is None else _longest_hold(law.lambda_ / 2 * sample_time)
    return DelayMargin(_longest_approach(law, sample_time), hold)


def _longest_approach(law: PolarLaw, sample_time: float) -> int:
    delay = 0
    while delay < LONGEST and _approach_settles(law, sample_time, delay):
        delay += 1
    return delay - 1


def _approach_settles(law: PolarLaw, sample_time: float, delay: int) -> bool:
    """Whether (z - 1)(z - 1 - s) z^d + Ts ((lambda + gamma)(z - 1) + gamma h s) has all its roots
    inside the unit circle. For given s there is one angle at which they cross it."""
    ratio = _shrinking(law.gamma * sample_time, delay)
    if ratio is None:
        return False
    s = (1 - ratio) / ratio
    a, b = sample_time * (law.lambda_ + law.gamma), sample_time * law.gamma * law.h * s
    half = s**2 + a * b - a**2
    q = (math.sqrt(half**2 + 4 * (1 + s) * b**2) - half) / (2 * (1 + s))  # |z - 1|^2
    if q >= 4:
        return False
    angle = 2 * math.asin(math.sqrt(q) / 2)
    w = cmath.exp(1j * angle) - 1
    turned = cmath.phase(-(a * w + b) / (w * (w - s)))
    return delay * angle < turned


def _shrinking(gain: float, delay: int) -> float | None:
    """The ratio r of one tick's distance to the last one's: the larger real root of
    r^d (1 - r) = gain. None: there is none, and the robot runs past its goal."""
    low, high = delay / (delay + 1), 1.0
    if low**delay * (1 - low) <= gain:
        return None
    while low < (ratio := (low + high) / 2) < high:
        low, high = (ratio, high) if ratio**delay * (1 - ratio) > gain else (low, ratio)
    return ratio


def _longest_hold(gain: float) -> int:
    """The largest d with z^(d+1) - z^d + gain stable: gain < 2 sin(pi / (2 (2 d + 1)))."""
    if gain >= 2:
        return -1
    limit = (math.pi / (2 * math.asin(gain / 2)) - 1) / 2
    return min(math.ceil(limit) - 1, LONGEST)
