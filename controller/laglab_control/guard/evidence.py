"""What the last innovations say together: whether the claimed covariance can explain them.

Of a filter that is right about itself the normalised innovations squared (NIS) are chi-square with
3 degrees of freedom each, and the innovations of different ticks are independent of each other with
mean 0. Both are tested over windows, at a level that a run of thousands of ticks seldom reaches.
"""

from collections.abc import Sequence
from typing import NamedTuple

from laglab_control.chi_square import chi_square_bound
from laglab_control.estimators.kalman import Triangle, weighted
from laglab_control.past.log import Log, append, logged

IMPROBABLE = 1e-6
"""The level of a wild measurement, and of a spread: successive windows share most of what is in
them, so a run of thousands of ticks seldom gets there (docs/theory.md)."""
DEGREES = 3
"""Degrees of freedom of one innovation."""
WILD = chi_square_bound(IMPROBABLE, DEGREES)
"""An NIS above this is not noise."""
SPREAD = 25
"""Innovations whose NIS are summed: sees a robot that is elsewhere at once."""
DRIFTS = (12, 40, 200)
"""Innovations whose mean is taken: sees an estimate that lags behind by less than the noise."""
SUSPECT = chi_square_bound(1e-3, DEGREES)
"""N b^T S^-1 b above this is improbable: b is claimed as an error."""
LAGGING = chi_square_bound(3e-6, DEGREES)
"""N b^T S^-1 b above this is not noise. It is looked at less often, so the level may be higher."""
FEWEST_OF_SPREAD = 3
EVERY = 3
"""The drift is looked for at each third innovation: it does not come suddenly."""


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


def weighed(evidence: Evidence, innovation: Sequence[float], nis: float) -> Evidence:
    """With one more innovation (3,); of a wild one only that it is wild."""
    total, x, y, theta = evidence.newest
    if not nis <= WILD:  # nor is what is not finite
        return append(evidence, Sums(total + WILD, x, y, theta), DRIFTS[-1] + 1)
    v_x, v_y, v_theta = innovation
    sums = Sums(total + nis, x + v_x, y + v_y, theta + v_theta)
    return append(evidence, sums, DRIFTS[-1] + 1)


class Lag(NamedTuple):
    """The estimate lies beside what the last measurements say."""

    innovations: int
    """How many."""
    mean: tuple[float, float, float]
    """b [m, m, rad], their mean."""
    statistic: float
    """N b^T S^-1 b, with the S of the newest: chi-square with 3 degrees if it is noise."""


class Contradiction(NamedTuple):
    """What cannot be noise."""

    cause: str
    """In a line."""
    drift: bool
    """Whether the estimate lags behind, as with a wrong model; else it is somewhere else."""


def contradiction(evidence: Evidence, lag: Lag | None) -> Contradiction | None:
    """None when all can be noise."""
    if cause := _spread(evidence):
        return Contradiction(cause, drift=False)
    if lag is None or lag.statistic <= LAGGING:
        return None
    x, y, theta = lag.mean
    cause = (
        f"the last {lag.innovations} measurements lie on one side of the estimate: on average by "
        f"{x:.3f} m, {y:.3f} m, {theta:.3f} rad"
    )
    return Contradiction(cause, drift=True)


def lagging(evidence: Evidence, weights: Triangle, before: Lag | None) -> Lag | None:
    """The most telling of the windows' means, if it is improbable; `before` where none is taken.

    `weights`: S^-1 of the newest innovation.
    """
    items, length = evidence
    if length % EVERY:
        return before
    worst = None
    for count in windows(length - 1):
        mean = _mean(items[length - 1 - count], items[length - 1], count)
        statistic = count * weighted(mean, weights)
        if statistic > (worst.statistic if worst else SUSPECT):
            worst = Lag(count, mean, statistic)
    return worst


def windows(there: int) -> list[int]:
    """The lengths of the windows over `there` innovations: the full ones, and one not yet full."""
    full = [count for count in DRIFTS if count <= there]
    return [*full, there] if full and there < DRIFTS[-1] and there not in full else full


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


def _mean(oldest: Sums, newest: Sums, count: int) -> tuple[float, float, float]:
    x, y, theta = newest.x - oldest.x, newest.y - oldest.y, newest.theta - oldest.theta
    return x / count, y / count, theta / count
