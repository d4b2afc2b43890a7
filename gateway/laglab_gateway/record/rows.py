"""What is kept of each tick besides the trace."""

import math
from typing import NamedTuple

from laglab_protocol import Estimate

FOLLOWED = "no"
"""`ArrivalRow.refused` of what was not refused."""


class TimingRow(NamedTuple):
    """How long after its deadline a tick began [s], and how long after that its answer came [s]."""

    tick: int
    lateness: float
    answer: float | None


class ArrivalRow(NamedTuple):
    """A message that came out of the link: its stamp, the tick at which it came, that tick's time
    since the run's first [s]; and why the robot refused it, if it did.

    `arrived` of a command is the tick at which it came into force, or would have; of a real robot,
    or as a station alone sees it, the tick that measurements tell.
    """

    direction: str
    tick: int
    arrived: int
    time: float
    refused: str = FOLLOWED


class ClaimRow(NamedTuple):
    """The covariance P that the station claims for its estimate of a tick [m², m rad, rad²], by its
    upper triangle; the tick's time since the run's first [s]."""

    tick: int
    time: float
    p_xx: float
    p_xy: float
    p_xt: float
    p_yy: float
    p_yt: float
    p_tt: float


def claimed(estimate: Estimate, time: float) -> ClaimRow | None:
    """What an estimate claims of itself; None where it claims nothing."""
    of = estimate
    if math.isnan(of.p_xx):
        return None
    return ClaimRow(of.tick, time, of.p_xx, of.p_xy, of.p_xt, of.p_yy, of.p_yt, of.p_tt)


class Notes:
    """Arrivals and claims, as they come, until they are taken."""

    def __init__(self, sample_time: float) -> None:
        self._sample_time = sample_time
        self._arrivals: list[ArrivalRow] = []
        self._claims: list[ClaimRow] = []

    def came(
        self, direction: str, stamp: int, tick: int, elapsed: int, refused: str = FOLLOWED
    ) -> None:
        """What bears this stamp came out of the link at `tick`, `elapsed` ticks into the run."""
        time = elapsed * self._sample_time
        self._arrivals.append(ArrivalRow(direction, stamp, tick, time, refused))

    def said(self, estimate: Estimate, elapsed: int) -> None:
        """The station said this of its estimate, `elapsed` ticks into the run."""
        if row := claimed(estimate, elapsed * self._sample_time):
            self._claims.append(row)

    def take_arrivals(self) -> list[ArrivalRow]:
        """All since the last call."""
        arrivals, self._arrivals = self._arrivals, []
        return arrivals

    def take_claims(self) -> list[ClaimRow]:
        """All since the last call."""
        claims, self._claims = self._claims, []
        return claims
