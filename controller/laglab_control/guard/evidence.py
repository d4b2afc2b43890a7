"""What the last innovations say together: whether the claimed covariance can explain them.

Of a filter that is right about itself the normalised innovations squared (NIS) are chi-square with
3 degrees of freedom each, and the innovations of different ticks are independent of each other with
mean 0. Both are tested over windows, at a level that a run of thousands of ticks seldom reaches.
"""

from typing import NamedTuple

import numpy as np

from laglab_control.chi_square import chi_square_bound
from laglab_control.estimators.kalman import Innovation, normalised_squared
from laglab_control.past.log import Log, append, logged

IMPROBABLE = 1e-6
"""The level of each test. Successive windows share most of what is in them: of 4000 runs of 2000
ticks of a filter that is right about itself 99.5 % stayed below."""
DEGREES = 3
"""Of one innovation."""
WILD = chi_square_bound(IMPROBABLE, DEGREES)
"""An NIS above this is not noise."""
SPREAD = 25
"""Innovations whose NIS are summed: sees a robot that is elsewhere at once."""
DRIFT = 200
"""Innovations whose mean is taken: sees an estimate that lags behind by less than the noise."""
FEWEST_OF_SPREAD = 3
FEWEST_OF_DRIFT = 50
EVERY = 10
"""The drift is looked for at each tenth innovation: it does not come suddenly."""


class Sums(NamedTuple):
    """Over all innovations so far."""

    nis: float
    """Each clipped at WILD, so that one alone proves nothing."""
    x: float
    y: float
    theta: float


Evidence = Log[Sums]
"""The sums after each innovation, and before the first; so a window's is a difference."""

NO_EVIDENCE = Sums(0.0, 0.0, 0.0, 0.0)


def no_evidence() -> Evidence:
    """Before the first innovation."""
    return logged(NO_EVIDENCE)


def weighed(evidence: Evidence, innovation: Innovation, nis: float) -> Evidence:
    """With one more; of a wild one only that it is wild."""
    total, x, y, theta = evidence.newest
    if not nis <= WILD:  # nor is what is not finite
        return append(evidence, Sums(total + WILD, x, y, theta), DRIFT + 1)
    v_x, v_y, v_theta = innovation.value.tolist()
    sums = Sums(total + nis, x + v_x, y + v_y, theta + v_theta)
    return append(evidence, sums, DRIFT + 1)


def contradiction(evidence: Evidence, innovation: Innovation) -> str | None:
    """What cannot be noise, said in a line; None when all can. `innovation` is the newest."""
    return _spread(evidence) or _drift(evidence, innovation)


def _spread(evidence: Evidence) -> str | None:
    items, length = evidence
    count = min(length - 1, SPREAD)
    if count < FEWEST_OF_SPREAD:
        return None
    total = items[length - 1].nis - items[length - 1 - count].nis
    bound = chi_square_bound(IMPROBABLE, DEGREES * count)
    if total <= bound:
        return None
    return (
        f"the last {count} measurements are not where the estimate has the robot: their normalised "
        f"innovations squared add up to {total:.0f}, noise stays below {bound:.0f}"
    )


def _drift(evidence: Evidence, innovation: Innovation) -> str | None:
    """N b^T S^-1 b of the mean b of N innovations, with the S of the newest, is chi-square too."""
    items, length = evidence
    count = min(length - 1, DRIFT)
    if count < FEWEST_OF_DRIFT or length % EVERY:
        return None
    newest, oldest = items[length - 1], items[length - 1 - count]
    mean = [(new - old) / count for new, old in zip(newest[1:], oldest[1:], strict=True)]
    if count * normalised_squared(Innovation(np.array(mean), innovation.S)) <= WILD:
        return None
    x, y, theta = mean
    return (
        f"the last {count} measurements lie on one side of the estimate: on average by {x:.3f} m, "
        f"{y:.3f} m, {theta:.3f} rad"
    )
