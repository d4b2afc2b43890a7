"""The end that measures."""

import secrets
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from laglab.link.errors import BegunAgainError, LinkPlaceError, NobodyAnswersError
from laglab.link.measured import Flags, Flow, MeasuredLink, bursts, gaps
from laglab.link.probing.clock import WallClock
from laglab.link.probing.clocks import Clocks, seen_by_clocks
from laglab.link.probing.ends import SESSIONS, Prober, following
from laglab.link.probing.sizes import Sizes, filler_for, overload, real_sizes
from laglab_protocol import (
    PROBE_LAGS,
    ROBOT_SYSTEM,
    Codec,
    EndpointError,
    Listener,
    Probe,
    Refusals,
)

LEAST_ASKED = 0.02
"""[s] The shortest interval of probes before anybody has answered."""

CutShort = KeyboardInterrupt | EndpointError | BegunAgainError
"""What ends a measurement before its time."""


class ProbePlan(NamedTuple):
    """How a link is measured."""

    frames: int
    """Each way."""
    interval: float
    """[s] From one to the next."""
    wait: float
    """[s] Within which somebody must answer."""
    within: float | None
    """[s] Within which the two clocks agree; None: that is not known."""


class Probed(NamedTuple):
    """What was measured of a link."""

    link: MeasuredLink
    cut_short: CutShort | None
    """What ended it before its time."""


class _Talk:
    """Says what is due, hears what comes."""

    def __init__(self, link: Listener, codec: Codec, tell: Callable[[str], None]) -> None:
        self._link = link
        self._sender = codec.sender
        self._tell = tell
        self.clock = WallClock()
        self._refusals = Refusals(self.clock() * 1e-9)

    def hear_until(self, due_ns: int) -> Iterator[tuple[Probe, int]]:
        """The other end's probes and when they came."""
        while True:
            frames = self._link.listen(max(due_ns - self.clock(), 0) * 1e-9)
            now = self.clock()
            for frame in frames:
                if frame.system == ROBOT_SYSTEM and isinstance(frame.message, Probe):
                    yield frame.message, now
            if now >= due_ns:
                break
        for line in self._refusals.news([self._link], now * 1e-9):
            self._tell(f"warning: {line}")

    def say(self, prober: Prober) -> None:
        """What does not fit into the line now is lost, as it would be in a run."""
        self._link.link.offer(self._sender.frame(prober.say(self.clock())))


def probe(
    link: Listener,
    codec: Codec,
    plan: ProbePlan,
    told: Callable[[Prober], None],
    tell: Callable[[str], None],
) -> Probed:
    """Measure the link to whoever answers there; `told` is told how it goes.

    Raises NobodyAnswersError, LinkPlaceError when what answers has a rate of its own, and before
    anything is measured KeyboardInterrupt, and an EndpointError when the link is gone, or
    BegunAgainError.
    """
    sizes = real_sizes(codec.sender)
    if said := overload(link.link.name, sizes, plan.interval):
        tell(f"warning: {said}")
    filler = filler_for(codec.sender, sizes.command)
    interval_us = round(plan.interval * 1e6)
    talk = _Talk(link, codec, tell)
    session = secrets.randbelow(SESSIONS)
    _find(talk, Prober(session, 0, interval_us, filler), plan, link.link.name)
    prober = Prober(following(session), plan.frames, interval_us, filler)
    cut_short = _ask(talk, prober, told, link.link.name)
    return Probed(_measured(prober, plan, sizes), cut_short)


def _find(talk: _Talk, prober: Prober, plan: ProbePlan, name: str) -> None:
    """Ask until somebody answers, twice at least."""
    due = talk.clock()
    wait = max(plan.wait, 2 * plan.interval)
    end = due + int(wait * 1e9)
    while due < end:
        talk.say(prober)
        due += int(max(plan.interval, LEAST_ASKED) * 1e9)
        for message, _ in talk.hear_until(due):
            if message.session == prober.end.session:
                if message.interval_us != prober.end.interval_us:
                    raise LinkPlaceError(
                        f"{name}: what answers there sends every {message.interval_us * 1e-6:g} s "
                        f"and no other: give --interval {message.interval_us * 1e-6:g}"
                    )
                return
    raise NobodyAnswersError(
        f"{name}: nobody answers ({wait:g} s): start `laglab link echo` at the far end, with the "
        "same --key or none; or it is busy: it answers one `laglab link probe` at a time"
    )


def _ask(talk: _Talk, prober: Prober, told: Callable[[Prober], None], name: str) -> CutShort | None:
    """All that is to be asked; gives what cut it short after something was measured."""
    due = talk.clock()
    try:
        while not prober.is_done(talk.clock()):
            talk.say(prober)
            told(prober)
            due += prober.end.interval_us * 1000
            for message, now in talk.hear_until(due):
                prober.hear(message, now)
            if prober.far_end_began_again:
                raise BegunAgainError(
                    f"{name}: what answers there was started again: what was measured before is "
                    "kept; measure again"
                )
    except (KeyboardInterrupt, EndpointError, BegunAgainError) as error:
        began_again = isinstance(error, BegunAgainError)
        prober.cut(prober.last_heard_ns if began_again else talk.clock())
        if not prober.answered:
            raise
        return error
    return None


def _measured(prober: Prober, plan: ProbePlan, sizes: Sizes) -> MeasuredLink:
    ours, theirs = prober.times()
    clocks = seen_by_clocks(ours, theirs, plan.within)
    notes = [clocks.note]
    if (hidden := hidden_arrivals(clocks)) >= 0.5:
        notes.append(
            f"About {hidden:.0f} of the commands that count as lost came: what tells of them was "
            "lost, each of three times."
        )
    if (gap := max(bursts(np.isnan(clocks.theirs)), default=0)) > PROBE_LAGS[-1]:
        notes.append(
            f"For {gap * plan.interval:.3g} s nothing came back: commands that came meanwhile, and "
            "of which nothing was told, count as lost."
        )
    return MeasuredLink(
        Flow(ours.sent, clocks.ours, sizes.command),
        Flow(theirs.sent, clocks.theirs, sizes.measurement),
        plan.interval,
        tuple(notes),
    )


def hidden_arrivals(clocks: Clocks) -> float:
    """How many commands probably came though no report of them did, if each frame is lost by
    itself; in a silence they are not, so nothing is said of it."""
    counts = _outside_silences(np.isnan(clocks.theirs))
    if not counts.any():
        return 0.0
    lost = float(np.isnan(clocks.theirs[counts]).mean()) ** len(PROBE_LAGS)
    told = int(np.sum(~np.isnan(clocks.ours[counts])))
    return told * lost / (1 - lost)


def _outside_silences(lost: Flags) -> Flags:
    """Which frames lie in no gap that outlasts what is told again, nor in the one at the end: after
    that nothing was heard, so it may have been as long."""
    counts = np.ones(len(lost), dtype=bool)
    for first, before in gaps(lost):
        if before - first > PROBE_LAGS[-1] or before == len(lost):
            counts[first:before] = False
    return counts
