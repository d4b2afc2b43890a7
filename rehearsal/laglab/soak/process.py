"""A process of one side: `laglab gateway` or `laglab controller`, as a user starts it."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from time import monotonic

from laglab.soak.files import faults_of, left_in, told_of
from laglab.soak.played import Part, Sample
from laglab.soak.system import look
from laglab.soak.turn import Side, Signal
from laglab_gateway import TLOG_FILE

MARK = "LAGLAB_SOAK"
PAUSE = 1.5
"""[s] So long a process stands still after a SIGSTOP."""
LAST_CHANCE = 20.0
"""[s] Who is sent home and has not gone after so long is killed."""


class Process:
    """Started, looked at, struck; in the end it is a `Part`."""

    def __init__(self, side: Side, arguments: Sequence[str], folder: Path, mark: str) -> None:
        self.side = side
        self.folder = folder
        self._temporary = folder.with_name(f"{folder.name}.tmp")
        self._output = folder.with_name(f"{folder.name}.out")
        self._temporary.mkdir()
        self._samples: list[tuple[int, Sample]] = []
        self._most_memory = 0
        self._signal: Signal | None = None
        self._paused: float | None = None
        self._sent_home: float | None = None
        self.obeys = False
        self.ended_at: float | None = None
        self.started_at = monotonic()
        with self._output.open("wb") as output, _heeding_signals():
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-m", "laglab", side, *arguments, "--out", str(folder)],
                env=os.environ | {"TMPDIR": str(self._temporary), MARK: mark, "COLUMNS": "200"},
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,  # a Ctrl-C in the terminal is for us, who end it
            )

    @property
    def running(self) -> bool:
        """Whether it still runs."""
        if self._process.poll() is None:
            return True
        self.ended_at = self.ended_at or monotonic()
        return False

    @property
    def said(self) -> str:
        """Up to now, on standard output and error."""
        return self._output.read_text(errors="replace")

    @property
    def met(self) -> bool:
        """Whether it has met the other side: it has recorded something."""
        return bool(self._samples)

    @property
    def sent_home(self) -> bool:
        """Whether it was sent home."""
        return self._sent_home is not None

    def look(self) -> None:
        """Note what it takes; a sample only while the run is under way, not after a signal."""
        seen = look(self._process.pid)
        if seen is None:
            return
        self.obeys = seen.obeys
        self._most_memory = max(self._most_memory, seen.most_memory)
        recorded = self._recorded()
        if recorded and self._signal is None and not self.sent_home:
            self._samples.append((recorded, Sample(seen.memory, seen.descriptors)))

    def strike(self, which: Signal) -> None:
        """Send it a signal."""
        self._signal = which
        self._process.send_signal(signal.Signals[which])
        self._paused = monotonic() if which == "SIGSTOP" else None

    def go_on_again(self) -> None:
        """After a pause."""
        if self._paused is not None and monotonic() - self._paused > PAUSE:
            self._paused = None
            self._process.send_signal(signal.SIGCONT)

    def send_home(self) -> None:
        """As a Ctrl-C does; when that was in vain, by force."""
        if self._sent_home is None:
            self._sent_home = monotonic()
            self._process.send_signal(signal.SIGINT)
        elif monotonic() - self._sent_home > LAST_CHANCE:
            self._process.kill()

    def kill(self) -> None:
        """Kill it, whatever it does."""
        self._process.kill()
        self._process.wait()

    def part(self) -> Part:
        """What became of it, once it has ended."""
        last, met = self._recorded(), self.met
        exit_code = self._process.wait()
        verdict, ticks = told_of(self.folder)
        return Part(
            side=self.side,
            exit_code=exit_code,
            said=self.said,
            met=met,
            samples=tuple(sample for recorded, sample in self._samples if recorded < last),
            most_memory=self._most_memory,
            signal=self._signal,
            dismissed=self.sent_home,
            verdict=verdict,
            faults=tuple(faults_of(self.folder, self._signal == "SIGKILL")) if met else (),
            left=tuple(left_in(self.folder, self._temporary)),
            ticks=ticks,
        )

    def _recorded(self) -> int:
        """[bytes]"""
        try:
            return (self.folder / TLOG_FILE).stat().st_size
        except OSError:
            return 0


@contextmanager
def _heeding_signals() -> Iterator[None]:
    """What is started meanwhile obeys them, though we were perhaps started to ignore them."""
    usual = {
        which: signal.signal(which, signal.SIG_DFL) for which in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        yield
    finally:
        for which, handler in usual.items():
            signal.signal(which, handler)
