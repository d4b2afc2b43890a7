"""Turn after turn, until the time is over."""

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from time import monotonic

from laglab.bench import Machine, this_machine
from laglab.files import json_of, write_whole
from laglab.soak.draw import draw, generator
from laglab.soak.expectations import failures
from laglab.soak.play import play
from laglab.soak.played import Played
from laglab.soak.report import SCHEMA, Report
from laglab.soak.tally import Failures, Tally
from laglab.version import laglab_version

TURN_FILE = "turn.json"
JSON_FILE, MARKDOWN_FILE = "soak.json", "soak.md"

OnFailure = Callable[[list[str]], None]


@dataclass
class Soak:
    """One that goes on; its failures are told at once, in lines."""

    command: str
    seed: int
    folder: Path
    told: OnFailure
    tally: Tally = field(default_factory=Tally)
    began: datetime = field(default_factory=lambda: datetime.now(UTC))
    machine: Machine = field(default_factory=this_machine)
    _start: float = field(default_factory=monotonic)

    def turns(self, seconds: float, passed: Callable[[float], None]) -> None:
        """One after the other; `passed` is told of the seconds. Raises ResultsError, OSError."""
        while (elapsed := monotonic() - self._start) < seconds:
            passed(elapsed)
            self.turn(self.tally.turns + 1)

    def turn(self, number: int) -> None:
        """Play that one; its record is kept if something was not as expected."""
        turn = draw(generator(self.seed, number), number)
        place = self.folder / f"turn-{number}"
        with _whole_or_gone(place):
            played = play(turn, place)
        failed = failures(played)
        again = repeated(self.seed, number)
        self.tally.add(played, failed, again)
        if failed:
            _keep(played, failed, place)
            said = [f"turn {number}: {name}: {'; '.join(how)}" for name, how in failed.items()]
            self.told([*said, f"  again: {again}; its record: {place}"])
        else:
            shutil.rmtree(place)

    def report(self) -> Report:
        """Up to now."""
        seconds = monotonic() - self._start
        return Report(
            schema=SCHEMA,
            laglab=laglab_version(),
            command=self.command,
            seed=self.seed,
            began=self.began,
            seconds=seconds,
            machine=self.machine,
            tally=self.tally,
        )

    def write(self) -> None:
        """The report, both ways. Raises ResultsError."""
        report = self.report()
        for name, text in ((JSON_FILE, json_of(report)), (MARKDOWN_FILE, report.to_markdown())):
            write_whole(self.folder / name, text)


def repeated(seed: int, number: int) -> str:
    """The command that plays the turn again."""
    return f"laglab soak --seed {seed} --turn {number}"


def _keep(played: Played, failed: Failures, place: Path) -> None:
    write_whole(place / TURN_FILE, json_of({"played": played, "failures": failed}))


@contextmanager
def _whole_or_gone(place: Path) -> Iterator[None]:
    """Half a turn is worth nothing."""
    try:
        yield
    except BaseException:
        shutil.rmtree(place, ignore_errors=True)
        raise
