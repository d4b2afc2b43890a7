"""Who is told what happens in a run, and keeps it."""

from collections.abc import Iterable

from laglab_gateway.link.log import LinkRow
from laglab_gateway.record.rows import ArrivalRow, ClaimRow, TimingRow
from laglab_gateway.record.trace import TraceRow


class Recorder:
    """Told of all that happens, as it happens; this one keeps nothing.

    Any method may raise TraceError when what it is told cannot be kept.
    """

    def row(self, row: TraceRow) -> None:
        """One tick is over."""

    def frames(self, time_us: int, frames: Iterable[bytes]) -> None:
        """Whole frames crossed the link, either way, at `time_us` of simulation time."""

    def link(self, rows: Iterable[LinkRow]) -> None:
        """What an impaired link did to frames."""

    def arrivals(self, rows: Iterable[ArrivalRow]) -> None:
        """What came out of the link at this tick."""

    def claims(self, rows: Iterable[ClaimRow]) -> None:
        """What the station claims for its estimate of this tick, if it does."""

    def timing(self, row: TimingRow) -> None:
        """One tick began, on the wall clock."""

    def flush(self) -> None:
        """Nobody waits for this side now: a good moment to write."""

    def close(self) -> None:
        """The run is over."""


class Tapped(Recorder):
    """Passes everything on to several recorders, each of which sees all of it."""

    def __init__(self, *recorders: Recorder) -> None:
        self._recorders = recorders

    def row(self, row: TraceRow) -> None:
        for recorder in self._recorders:
            recorder.row(row)

    def frames(self, time_us: int, frames: Iterable[bytes]) -> None:
        frames = list(frames)
        for recorder in self._recorders:
            recorder.frames(time_us, frames)

    def link(self, rows: Iterable[LinkRow]) -> None:
        rows = list(rows)
        for recorder in self._recorders:
            recorder.link(rows)

    def arrivals(self, rows: Iterable[ArrivalRow]) -> None:
        rows = list(rows)
        for recorder in self._recorders:
            recorder.arrivals(rows)

    def claims(self, rows: Iterable[ClaimRow]) -> None:
        rows = list(rows)
        for recorder in self._recorders:
            recorder.claims(rows)

    def timing(self, row: TimingRow) -> None:
        for recorder in self._recorders:
            recorder.timing(row)

    def flush(self) -> None:
        for recorder in self._recorders:
            recorder.flush()

    def close(self) -> None:
        for recorder in self._recorders:
            recorder.close()


class MemoryRecorder(Recorder):
    """Keeps all of a run in lists."""

    def __init__(self) -> None:
        self.rows: list[TraceRow] = []
        self.tlog: list[tuple[int, bytes]] = []
        """Each frame, with its time [µs]."""
        self.link_rows: list[LinkRow] = []
        self.arrival_rows: list[ArrivalRow] = []
        self.claim_rows: list[ClaimRow] = []
        self.timing_rows: list[TimingRow] = []

    def row(self, row: TraceRow) -> None:
        self.rows.append(row)

    def frames(self, time_us: int, frames: Iterable[bytes]) -> None:
        self.tlog += [(time_us, frame) for frame in frames]

    def link(self, rows: Iterable[LinkRow]) -> None:
        self.link_rows += rows

    def arrivals(self, rows: Iterable[ArrivalRow]) -> None:
        self.arrival_rows += rows

    def claims(self, rows: Iterable[ClaimRow]) -> None:
        self.claim_rows += rows

    def timing(self, row: TimingRow) -> None:
        self.timing_rows.append(row)
