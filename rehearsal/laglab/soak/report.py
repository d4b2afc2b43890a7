"""What a soak found, for programs (JSON), pages (Markdown) and terminals."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime
from itertools import chain

from rich.table import Table

from laglab.bench.result import Machine
from laglab.soak.tally import Tally
from laglab.tables import plain_table

SCHEMA = 1
"""The version of the JSON: another one when a field means something else."""
MB = 1 << 20


@dataclass(frozen=True)
class Report:
    """All of a soak."""

    schema: int
    laglab: str
    """Its version."""
    command: str
    seed: int
    began: datetime
    seconds: float
    machine: Machine
    tally: Tally

    def to_markdown(self) -> str:
        """A section of a page."""
        return "\n".join(_lines(self)) + "\n"


def _lines(report: Report) -> Iterator[str]:
    tally, machine = report.tally, report.machine
    yield f"`{report.command}`, laglab {report.laglab}, {report.began:%Y-%m-%d}, on {machine.cpus}"
    yield f"cores, Python {machine.python}, {machine.platform.partition('-')[0]}:"
    yield ""
    yield f"**{verdict(report)}**"
    yield f"{tally.ticks} ticks, {tally.datagrams} datagrams from strangers."
    yield ""
    yield from _table(("expectation", "turns that failed it"), _expectations(tally))
    yield from _table(("kind of turn", "turns", "failed"), _kinds(tally))
    yield from _table(("side", "MB of its own, highest", "MB in all, highest"), _memory(tally))
    yield from _table(("side", "exit code", "times"), _codes(tally))
    if tally.failed:
        yield from _table(("failed", "by itself", "how"), _failed(tally))


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> Iterator[str]:
    yield f"| {' | '.join(head)} |"
    yield "|---" + "|---:" * (len(head) - 1) + "|"
    yield from (f"| {' | '.join(row)} |" for row in rows)
    yield ""


def verdict(report: Report) -> str:
    """In a line."""
    tally = report.tally
    said = f"{len(tally.failed)} of them failed" if tally.failed else "all as expected"
    return f"{tally.turns} turns in {report.seconds / 60:.1f} minutes, {said}."


def summary_tables(report: Report) -> Iterator[Table]:
    """For a terminal."""
    tally = report.tally
    yield _shown(("kind of turn", "turns", "failed"), _kinds(tally))
    yield _shown(("expectation", "failed"), _expectations(tally))
    yield _shown(("side", "MB of its own", "MB in all"), _memory(tally))


def _shown(head: Sequence[str], rows: Sequence[Sequence[str]]) -> Table:
    table = plain_table()
    for name in head:
        table.add_column(name, justify="left" if name == head[0] else "right")
    for row in rows:
        table.add_row(*row)
    return table


def _expectations(tally: Tally) -> list[tuple[str, ...]]:
    return [(name, str(failed)) for name, failed in tally.expectations.items()]


def _kinds(tally: Tally) -> list[tuple[str, ...]]:
    return [(kind, str(of.turns), str(of.failed)) for kind, of in sorted(tally.kinds.items())]


def _memory(tally: Tally) -> list[tuple[str, ...]]:
    return [
        (side, f"{of.running / MB:.0f}", f"{of.ever / MB:.0f}") for side, of in tally.memory.items()
    ]


def _codes(tally: Tally) -> list[tuple[str, ...]]:
    return [
        (side, str(code), str(times))
        for side, codes in tally.exit_codes.items()
        for code, times in codes.items()
    ]


def _failed(tally: Tally) -> list[tuple[str, ...]]:
    return [
        (f"turn {each.turn}", f"`{each.repeat}`", "; ".join(chain(*each.failures.values())))
        for each in tally.failed
    ]
