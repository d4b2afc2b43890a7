"""What a station alone can keep of a run: what it heard and said."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

from laglab.results.heard import heard_ticks
from laglab_gateway import TLOG_FILE, FileRecorder, TraceRow
from laglab_station import Onlooker, SessionTick, read_session

LATEST = 1024
"""Ticks that a row waits for its measurement."""

Cells = dict[str, float | None]


class StationRecord(Onlooker):
    """Keeps the frames as `robot.tlog`; passes warnings and ticks on to who watches the screen."""

    def __init__(
        self,
        directory: Path,
        sample_time: float,
        warn: Callable[[str], None],
        progress: Callable[[int], None],
    ) -> None:
        self._directory = directory
        self._sample_time = sample_time
        self._recorder = FileRecorder(directory)
        self._warn = warn
        self._progress = progress

    def warned(self, text: str) -> None:
        self._warn(text)

    def said(self, frames: Sequence[bytes], tick: int | None) -> None:
        self._recorder.frames(round((tick or 0) * self._sample_time * 1e6), frames)

    def answered(self, tick: int) -> None:
        self._recorder.flush()
        self._progress(tick)

    def close(self) -> None:
        """What was heard, once more as a run's tables. Raises TraceError."""
        try:
            self._recorder.flush()
            session = self._noted(read_session(self._directory / TLOG_FILE))
            for row in station_rows(session, self._sample_time):
                self._recorder.row(row)
                if row.tick % LATEST == 0:
                    self._recorder.flush()
        finally:
            self._recorder.close()

    def _noted(self, session: Iterable[SessionTick]) -> Iterator[SessionTick]:
        """The same, its arrivals and claims recorded as it goes by."""
        for heard, arrivals, claims in heard_ticks(session, self._sample_time):
            self._recorder.arrivals(arrivals)
            self._recorder.claims(claims)
            yield heard


def station_rows(session: Iterable[SessionTick], sample_time: float) -> Iterator[TraceRow]:
    """A row a tick heard: no true pose; the measurement sampled then and the command in force from
    then on, however late the one came and the other was told of."""
    waiting: dict[int, Cells] = {}
    first: int | None = None
    for heard in session:
        first = heard.tick if first is None else first
        waiting[heard.tick] = _said(heard)
        for message in heard.measurements:
            if message.tick in waiting:
                x, y, theta = message.pose
                waiting[message.tick] |= {"x_meas": x, "y_meas": y, "theta_meas": theta}
            if message.tick - 1 in waiting:
                waiting[message.tick - 1] |= {"v": message.v, "omega": message.omega}
        while next(iter(waiting)) < heard.tick - LATEST:
            tick = next(iter(waiting))
            yield _row(tick, first, sample_time, waiting.pop(tick))
    for tick, cells in waiting.items():
        yield _row(tick, first or 0, sample_time, cells)


def _said(heard: SessionTick) -> Cells:
    cells: Cells = {}
    if heard.estimate:
        x, y, theta = heard.estimate.pose
        cells |= {"x_est": x, "y_est": y, "theta_est": theta}
    if heard.command:
        cells |= {"v_sent": heard.command.v, "omega_sent": heard.command.omega}
    return cells


def _row(tick: int, first: int, sample_time: float, cells: Cells) -> TraceRow:
    values = [cells.get(name) for name in TraceRow._fields[2:]]
    return TraceRow(tick, (tick - first) * sample_time, *values)
