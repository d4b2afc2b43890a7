"""The two ends of a link that is measured: what each says and keeps. No I/O, no clock."""

from bisect import bisect_right
from collections import deque

import numpy as np

from laglab.link.probing.clocks import ClockTimes
from laglab_protocol import NO_PROBE, PROBE_LAGS, Probe

SHORTEST = 1000
"""[us] The shortest interval at which probes are answered."""
SESSIONS = 2**32
KEPT = 2 * PROBE_LAGS[-1]
"""Arrivals."""
FORGOTTEN = 1.0
"""[s] A session is over when no probe came for this long, and for MISSED intervals,"""
MISSED, LONGEST = 3, 10_000_000
"""each counted as LONGEST [us] at most."""


def following(session: int) -> int:
    """The number of the measurer's next session."""
    return (session + 1) % SESSIONS


def _sessions_of(end: "ProbeEnd") -> tuple[int, int]:
    """Those of whoever measures: the one that is, and the one that may follow."""
    return end.session, following(end.session)


class ProbeEnd:
    """Numbers its probes, and tells in each what came: every arrival once in each place of `came`,
    so that no short gap in what is told hides it."""

    def __init__(self, session: int, interval_us: int, filler: tuple[int, ...]) -> None:
        self.session = session
        self.interval_us = interval_us
        self.said = 0
        self.heard = 0
        self._filler = filler
        self._came: deque[tuple[int, int]] = deque(maxlen=KEPT)
        self._next = [0] * len(PROBE_LAGS)
        """By place: the number of the arrival that is told next."""

    def say(self, now_ns: int) -> Probe:
        """The next probe, sent at `now_ns`."""
        came, came_ns = zip(*map(self._tell, range(len(PROBE_LAGS))), strict=True)
        sequence = self.said
        self.said += 1
        return Probe(now_ns, came_ns, self.session, sequence, self.interval_us, came, self._filler)

    def _tell(self, place: int) -> tuple[int, int]:
        oldest = self.heard - len(self._came)
        number = max(self._next[place], oldest)
        if number + PROBE_LAGS[place] >= self.heard:
            return NO_PROBE, 0
        self._next[place] = number + 1
        return self._came[number - oldest]

    def hear(self, probe: Probe, now_ns: int) -> None:
        """Take a probe of the other end, of this session."""
        self.heard += 1
        self._came.append((probe.sequence, now_ns))


class Answerer:
    """The end that answers: as often as it is asked to, for as long as it hears anything."""

    def __init__(self, filler: tuple[int, ...]) -> None:
        self._filler = filler
        self.end: ProbeEnd | None = None
        self._due_ns = 0
        self._heard_ns = 0

    def is_for(self, probe: Probe, now_ns: int) -> bool:
        """Whether this one is answered: another session waits until this one is over, but for the
        next number, which is the same measurer's."""
        if self.end is None or self._is_over(self.end, now_ns):
            return True
        return probe.session in _sessions_of(self.end)

    def hear(self, probe: Probe, now_ns: int) -> bool:
        """Take one that is answered; whether a measurer begins with it, who calls in one session
        and measures in the next."""
        begins = self.end is None or probe.session not in _sessions_of(self.end)
        if self.end is None or self.end.session != probe.session:
            interval_us = max(probe.interval_us, SHORTEST)
            self.end, self._due_ns = ProbeEnd(probe.session, interval_us, self._filler), now_ns
        self.end.hear(probe, now_ns)
        self._heard_ns = now_ns
        return begins

    def wait(self, now_ns: int, longest: float) -> float:
        """How long there is nothing to say [s]."""
        return longest if self.end is None else max(self._due_ns - now_ns, 0) * 1e-9

    def say(self, now_ns: int) -> Probe | None:
        """What is due now, if anything is."""
        if self.end is None or now_ns < self._due_ns:
            return None
        self._due_ns += self.end.interval_us * 1000
        return self.end.say(now_ns)

    def take_over(self, now_ns: int) -> ProbeEnd | None:
        """The session that has ended by now; there is none any more."""
        ended = self.end
        if ended is None or not self._is_over(ended, now_ns):
            return None
        self.end = None
        return ended

    def _is_over(self, end: ProbeEnd, now_ns: int) -> bool:
        silent = max(FORGOTTEN, MISSED * min(end.interval_us, LONGEST) * 1e-6)
        return (now_ns - self._heard_ns) * 1e-9 >= silent


class Prober:
    """The end that asks: `count` probes, and more until what came of them is told."""

    def __init__(self, session: int, count: int, interval_us: int, filler: tuple[int, ...]) -> None:
        self.end = ProbeEnd(session, interval_us, filler)
        self.count = count
        self.answered = 0
        """How many of the other end's first `count` probes were heard."""
        self.far_end_began_again = False
        """Whether it numbers its probes from the first on once more."""
        self._sent: list[int] = []
        self._came: dict[int, int] = {}
        self._heard: dict[int, tuple[int, int]] = {}
        self._round_trip = 0

    @property
    def last_ns(self) -> int:
        """When the last of those that count was sent; before that, the last so far."""
        return self._sent[-1]

    @property
    def sent(self) -> int:
        """How many of those that count were sent."""
        return len(self._sent)

    @property
    def told(self) -> int:
        """Of how many of ours we know that they came."""
        return len(self._came)

    def say(self, now_ns: int) -> Probe:
        """The next, sent at `now_ns`."""
        if self.end.said < self.count:
            self._sent.append(now_ns)
        return self.end.say(now_ns)

    def hear(self, probe: Probe, now_ns: int) -> None:
        """Take a probe of the other end; those of another session are passed over."""
        if probe.session != self.end.session:
            return
        if before := self._heard.get(probe.sequence):
            self.far_end_began_again |= before[0] != probe.time_ns
            return
        self._heard[probe.sequence] = probe.time_ns, now_ns
        self.answered += probe.sequence < self.count
        for sequence, at_ns in zip(probe.came, probe.came_ns, strict=True):
            if sequence < len(self._sent):
                self._came.setdefault(sequence, at_ns)
        newest = probe.came[0]
        if newest < len(self._sent):
            there = now_ns - self._sent[newest] - (probe.time_ns - probe.came_ns[0])
            self._round_trip = max(self._round_trip, there)

    def is_done(self, now_ns: int) -> bool:
        """Whether nothing more is to be learnt, or it was waited for long enough."""
        if self.end.said < self.count:
            return False
        if self.told == self.count == self.answered:
            return True
        late = (now_ns - self.last_ns) * 1e-9
        patience = max(FORGOTTEN, 2e-9 * self._round_trip)
        if self.answered < self.count:  # with them reports were lost, which come again
            patience += min(PROBE_LAGS[-1] * self.end.interval_us * 1e-6, 4.0)
        return late > patience

    def cut(self, now_ns: int) -> None:
        """It is over before its time: those count that were sent so long ago that what came of them
        would be told by then."""
        told_after = self._round_trip + self.end.interval_us * 1000
        self.count = bisect_right(self._sent, now_ns - told_after)
        del self._sent[self.count :]
        self.answered = sum(number < self.count for number in self._heard)

    @property
    def last_heard_ns(self) -> int:
        """When something of the other end came last."""
        return max((came for _, came in self._heard.values()), default=0)

    def times(self) -> tuple[ClockTimes, ClockTimes]:
        """Of our frames, and of as many of the other end's: sent by one clock, came by the other.

        Of those that were not heard it is not known when they were sent: their numbers tell.
        """
        ours = ClockTimes.of(self._sent, [self._came.get(i) for i in range(len(self._sent))])
        sent, came = self._theirs()
        return ours, ClockTimes.of(sent, came)

    def _theirs(self) -> tuple[list[int], list[int | None]]:
        known = sorted(self._heard)
        if not known:
            return [], []
        numbers = np.arange(self.count)
        first = self._heard[known[0]][0]
        at = [self._heard[i][0] - first for i in known]
        sent = np.interp(numbers, known, at).astype(np.int64)
        beyond = numbers > known[-1]
        step = self.end.interval_us * 1000
        sent[beyond] = at[-1] + step * (numbers[beyond] - known[-1])
        came = [self._heard[i][1] if i in self._heard else None for i in range(self.count)]
        return [first + int(each) for each in sent], came
