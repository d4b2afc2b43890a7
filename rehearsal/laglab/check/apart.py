"""The checks in a process of their own: whatever somebody's code does, we are still here."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

from msgspec import Struct

from laglab.check import estimator, law, plant
from laglab.check.checking import checked
from laglab.check.finding import Finding
from laglab.check.subject import Kind, kind_of
from laglab.runs.processes.answers import NoAnswerError, answer_all, asked
from laglab.runs.processes.child import Tell
from laglab.scenario import assignment

PATIENCE = 60.0
"""[s] For a row; those that take 20 runs take a library's filter some seconds."""
ROWS: Mapping[Kind, Sequence[str]] = {
    "estimator": tuple(estimator.CHECKS),
    "law": tuple(law.CHECKS),
    "plant": tuple(plant.CHECKS),
}


class CheckOrder(Struct, frozen=True):
    """What to check."""

    name: str
    kind: Kind | None
    options: tuple[str, ...]
    """KEY=VALUE."""


class Checked(NamedTuple):
    """All that was found."""

    kind: Kind
    found: Sequence[Finding]


def checked_apart(order: CheckOrder, patience: float = PATIENCE) -> Checked:
    """A row for each check; where they do not come to their end, the last row says so.

    Raises GaveUpError: there is no such thing; NoAnswerError: its module does not come back.
    """
    with asked("check's", f"{__name__}:check", order, patience) as answer:
        try:
            kind: Kind = answer()
        except NoAnswerError as error:
            raise NoAnswerError(f"{order.name}, loading its module: {error}") from None
        return Checked(kind, list(_findings(answer, ROWS[kind])))


def _findings(answer: Callable[[], Finding | None], rows: Sequence[str]) -> Iterator[Finding]:
    """Up to the one at which nothing comes any more."""
    done = 0
    try:
        while (finding := answer()) is not None:
            yield finding
            done += 1
    except NoAnswerError as error:
        yield Finding(rows[done] if done < len(rows) else "end", "no", str(error))


def check(order: CheckOrder, tell: Tell) -> None:
    """In the child."""
    answer_all(tell, _answers(order))


def _answers(order: CheckOrder) -> Iterator[Kind | Finding | None]:
    """The kind, its rows, and None when there are no more."""
    kind = kind_of(order.name, order.kind)
    yield kind
    yield from checked(kind, order.name, dict(map(assignment, order.options)))
    yield None
