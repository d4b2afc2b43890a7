"""Ticks that are over, until there is time to record them."""

from collections.abc import Callable
from typing import NamedTuple

from laglab_gateway.link.log import LinkRow
from laglab_gateway.record.recorder import Recorder
from laglab_gateway.record.rows import ArrivalRow, ClaimRow
from laglab_gateway.record.trace import TraceRow
from laglab_gateway.side import RobotSide


class _Closed(NamedTuple):
    """What there is to record of a tick."""

    row: TraceRow
    link: list[LinkRow]
    arrivals: list[ArrivalRow]
    claims: list[ClaimRow]


class Unwritten:
    """What a run's recorder has not been told yet."""

    def __init__(self) -> None:
        self._closed: list[_Closed] = []

    def close_tick(self, gateway: RobotSide) -> None:
        """Close the gateway's tick, and keep what happened."""
        row, notes = gateway.close_tick(), gateway.notes
        self._closed.append(
            _Closed(row, gateway.take_link_rows(), notes.take_arrivals(), notes.take_claims())
        )

    def write_down(self, recorder: Recorder, progress: Callable[[int], None]) -> None:
        """Hand the recorder the ticks that were closed since the last time."""
        closed, self._closed = self._closed, []
        for tick in closed:
            recorder.row(tick.row)
            if tick.link:
                recorder.link(tick.link)
            if tick.arrivals:
                recorder.arrivals(tick.arrivals)
            if tick.claims:
                recorder.claims(tick.claims)
            progress(tick.row.tick)
