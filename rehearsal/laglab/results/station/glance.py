"""A run at a glance as its station sees it, from the frames that went by last."""

from collections import deque
from collections.abc import Sequence

from laglab.results.station.heard import decoded, heard_ticks
from laglab.runs.glance import Glance, Glances
from laglab.scenario import Scenario
from laglab_gateway import TraceRow
from laglab_station import SessionTick, heard

KEPT = 100
"""Frames: of a few ticks, however many go with each; they are read when somebody looks."""


class StationGlance:
    """Keeps the last frames. What was lost on the way a station does not know."""

    def __init__(self, scenario: Scenario) -> None:
        self._sample_time = scenario.sample_time
        self._glances = Glances(scenario)
        self._frames: deque[bytes] = deque(maxlen=KEPT)

    def said(self, frames: Sequence[bytes]) -> None:
        """More frames, of either side."""
        self._frames.extend(frames)

    def now(self) -> Glance | None:
        """At the last tick heard; None before the first."""
        session = heard(decoded(self._frames))
        for tick, arrivals, claims in heard_ticks(session, self._sample_time, 0):
            self._glances.arrivals(arrivals)
            if claims:
                self._glances.claims(claims)
            self._glances.row(self._row(tick))
        return self._glances.now(knows_losses=False)

    def _row(self, tick: SessionTick) -> TraceRow:
        pose = tick.estimate.pose if tick.estimate else (None, None, None)
        unknown = (None,) * 6
        time = tick.tick * self._sample_time
        return TraceRow._make((tick.tick, time, *unknown, *pose, None, None, None, None))
