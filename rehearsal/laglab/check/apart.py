"""The checks in a process of their own: whatever somebody's code does, we are still here."""

import pickle
from collections.abc import Mapping, Sequence
from queue import Empty, Queue
from typing import Any, NamedTuple

from msgspec import Struct

from laglab.check import estimator, law, plant
from laglab.check.checking import checked
from laglab.check.finding import Finding
from laglab.check.subject import Kind, kind_of
from laglab.errors import LaglabError, ScenarioError
from laglab.runs.child import Inbox, Tell, started
from laglab.runs.errors import SIDE_ERRORS
from laglab.runs.reports import Computed, Failed, Report
from laglab.scenario import assignment

PATIENCE = 60.0
"""[s] For a row; those that take 20 runs take a library's filter some seconds."""
ROWS: Mapping[Kind, Sequence[str]] = {
    "estimator": tuple(estimator.CHECKS),
    "law": tuple(law.CHECKS),
    "plant": tuple(plant.CHECKS),
}


class NoAnswerError(LaglabError):
    """What is to be checked cannot even be loaded in time; the text names it."""

    exit_code = 1


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
    """A row for each check; the last one says so if it does not come to its end.

    Raises ScenarioError: there is no such thing; NoAnswerError: its module does not come back.
    """
    inbox: Inbox = Queue()
    with started("check's", f"{__name__}:check", order, inbox):
        kind = _next(inbox, patience)
        if isinstance(kind, Stuck):
            raise NoAnswerError(f"{order.name}, loading its module: {kind.why}")
        found: list[Finding] = []
        while (finding := _next(inbox, patience)) is not None:
            if isinstance(finding, Stuck):
                row = dict(enumerate(ROWS[kind])).get(len(found), "end")
                found.append(Finding(row, "no", finding.why))
                break
            found.append(finding)
    return Checked(kind, found)


class Stuck(NamedTuple):
    """Nothing comes any more."""

    why: str


def _next(inbox: Inbox, patience: float) -> Any:
    """What the child sent, or that it is stuck."""
    try:
        report: Report = inbox.get(timeout=patience).report
    except Empty:
        return Stuck(f"it did not answer within {patience:g} s")
    match report:
        case Computed(answer):
            return pickle.loads(answer)
        case Failed(reason):
            raise ScenarioError(reason)
        case other:
            return Stuck(getattr(other, "how", "") or str(other))


def check(order: CheckOrder, tell: Tell) -> None:
    """In the child: the kind, its rows, and None when there are no more."""
    try:
        kind = kind_of(order.name, order.kind)
        tell(Computed(pickle.dumps(kind)))
        for finding in checked(kind, order.name, dict(map(assignment, order.options))):
            tell(Computed(pickle.dumps(finding)))
        tell(Computed(pickle.dumps(None)))
    except (LaglabError, *SIDE_ERRORS) as error:
        tell(Failed(str(error), begun=False))
