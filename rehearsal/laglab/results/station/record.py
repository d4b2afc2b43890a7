"""What a station alone can keep of a run: what it heard and said."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from laglab.results.station.glance import StationGlance
from laglab.results.station.heard import heard_ticks, origin
from laglab_control import MEMORY
from laglab_gateway import TLOG_FILE, FileRecorder, Recorder, TraceRow
from laglab_station import Onlooker, SessionTick, read_session

LATEST = MEMORY
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
        glance: StationGlance | None = None,
    ) -> None:
        self._directory = directory
        self._sample_time = sample_time
        self._recorder = FileRecorder(directory)
        self._warn = warn
        self._progress = progress
        self._glance = glance

    def warned(self, text: str) -> None:
        self._warn(text)

    def said(self, frames: Sequence[bytes], tick: int | None) -> None:
        if self._glance:
            self._glance.said(frames)
        self._recorder.frames(round((tick or 0) * self._sample_time * 1e6), frames)

    def answered(self, tick: int) -> None:
        self._recorder.flush()
        self._progress(tick)

    def close(self) -> None:
        """What was heard, once more as a run's tables. Raises TraceError."""
        try:
            self._recorder.write()
            session = read_session(self._directory / TLOG_FILE)
            record_session(session, self._sample_time, self._recorder)
        finally:
            self._recorder.close()


def record_session(
    session: Iterable[SessionTick], sample_time: float, recorder: Recorder, latest: int = LATEST
) -> None:
    """What was heard, once more as a run's tables; a row waits `latest` ticks for its measurement.

    Raises: TraceError, as the recorder does.
    """
    for row in station_rows(_noted(session, sample_time, recorder), sample_time, latest):
        recorder.row(row)
        if row.tick % LATEST == 0:
            recorder.flush()


def _noted(
    session: Iterable[SessionTick], sample_time: float, recorder: Recorder
) -> Iterator[SessionTick]:
    """The same, its arrivals and claims recorded as it goes by."""
    for heard, arrivals, claims in heard_ticks(session, sample_time):
        if arrivals:
            recorder.arrivals(arrivals)
        if claims:
            recorder.claims(claims)
        yield heard


def station_rows(
    session: Iterable[SessionTick], sample_time: float, latest: int = LATEST
) -> Iterator[TraceRow]:
    """A row a tick heard: no true pose; the measurement sampled then and the command in force from
    then on, however late the one came and the other was told of."""
    waiting: dict[int, Cells] = {}
    first, last = None, None
    for heard in session:
        if last is not None and heard.tick < last:
            yield from _rows(waiting, first or 0, sample_time)
            waiting = {}
        first, last = origin(first, last, heard.tick), heard.tick
        waiting[heard.tick] = _said(heard)
        for message in heard.measurements:
            if message.tick in waiting:
                x, y, theta = message.pose
                waiting[message.tick] |= {"x_meas": x, "y_meas": y, "theta_meas": theta}
            if message.tick - 1 in waiting:
                waiting[message.tick - 1] |= {"v": message.v, "omega": message.omega}
        while next(iter(waiting)) < heard.tick - latest:
            tick = next(iter(waiting))
            yield _row(tick, first, sample_time, waiting.pop(tick))
    yield from _rows(waiting, first or 0, sample_time)


def _rows(waiting: Mapping[int, Cells], first: int, sample_time: float) -> Iterator[TraceRow]:
    for tick, cells in waiting.items():
        yield _row(tick, first, sample_time, cells)


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
