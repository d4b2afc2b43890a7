"""A soak in numbers: what was tried, what failed, how much memory it took."""

from collections import Counter
from dataclasses import dataclass, field

from laglab.soak.expectations import EXPECTATIONS
from laglab.soak.played import Part, Played

Failures = dict[str, list[str]]


@dataclass
class Score:
    """Turns of one kind."""

    turns: int = 0
    failed: int = 0


@dataclass
class Failed:
    """A turn that was not as expected."""

    turn: int
    kinds: list[str]
    failures: Failures
    repeat: str
    """The command that plays it again."""


@dataclass
class Memory:
    """The most that a side took [bytes]."""

    running: int = 0
    """Its own, while its run was under way."""
    ever: int = 0
    """Libraries and figure included."""

    def add(self, part: Part) -> None:
        """One more process."""
        self.running = max([self.running, *(sample.memory for sample in part.samples)])
        self.ever = max(self.ever, part.most_memory)


@dataclass
class Tally:
    """Added up turn by turn; its size does not depend on how many there were."""

    turns: int = 0
    ticks: int = 0
    """That gateways have served."""
    datagrams: int = 0
    """That strangers have sent."""
    kinds: dict[str, Score] = field(default_factory=dict)
    expectations: dict[str, int] = field(default_factory=lambda: dict.fromkeys(EXPECTATIONS, 0))
    """The turns that failed each."""
    memory: dict[str, Memory] = field(default_factory=dict)
    failed: list[Failed] = field(default_factory=list)
    exit_codes: dict[str, dict[int, int]] = field(default_factory=dict)

    def add(self, played: Played, failures: Failures, repeat: str) -> None:
        """One more turn."""
        kinds = list(played.turn.kinds)
        self.turns += 1
        self.datagrams += played.datagrams
        for kind in kinds:
            score = self.kinds.setdefault(kind, Score())
            score.turns += 1
            score.failed += bool(failures)
        for name in failures:
            self.expectations[name] += 1
        for part in played.parts:
            self._add_part(part)
        if failures:
            self.failed.append(Failed(played.turn.number, kinds, failures, repeat))

    def _add_part(self, part: Part) -> None:
        self.memory.setdefault(part.side, Memory()).add(part)
        codes = Counter(self.exit_codes.get(part.side, {}))
        codes[part.exit_code] += 1
        self.exit_codes[part.side] = dict(sorted(codes.items()))
        self.ticks += part.ticks if part.side == "gateway" else 0
