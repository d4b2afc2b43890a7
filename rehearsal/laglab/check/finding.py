"""What a check has found."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Literal, NamedTuple, TypeVar

from rich.table import Table

from laglab.tables import plain_table
from laglab_control import ControlError

Held = Literal["yes", "no", "admitted", "-"]
"""`admitted`: it does not hold, and whoever brought it says so; `-`: there is nothing to hold."""
INTERFACE = "interface"
"""The first row: where it does not hold, nothing else can be tried."""
T = TypeVar("T")


class Finding(NamedTuple):
    """One row."""

    name: str
    held: Held
    said: str


class NotSoError(Exception):
    """What was looked for does not hold; the text says what was found instead."""


class NothingToHoldError(Exception):
    """It does not apply; the text says why."""


Check = Callable[[T], str]
"""Says how it holds. Raises NotSoError, NothingToHoldError, and what the subject itself raises."""


def findings(
    checks: Mapping[str, Check[T]], make: Callable[[], T], admits: Mapping[str, str]
) -> Iterator[Finding]:
    """A row each, in order; each check has a subject of its own."""
    for name, check in checks.items():
        finding = _found(name, check, make)
        if finding.held == "no" and name in admits:
            finding = Finding(name, "admitted", f"{admits[name]} ({finding.said})")
        yield finding
        if finding.held == "no" and name == INTERFACE:
            return


def _found(name: str, check: Check[T], make: Callable[[], T]) -> Finding:
    try:
        return Finding(name, "yes", check(make()))
    except NothingToHoldError as reason:
        return Finding(name, "-", str(reason))
    except (NotSoError, ControlError) as error:
        return Finding(name, "no", str(error))


def all_hold(found: Iterable[Finding]) -> bool:
    """Whether whatever does not hold was admitted."""
    return all(finding.held != "no" for finding in found)


def findings_table(found: Iterable[Finding]) -> Table:
    """For reading."""
    table = plain_table()
    table.add_column("check", no_wrap=True)
    table.add_column("holds", no_wrap=True)
    table.add_column("what was found", overflow="fold")
    for finding in found:
        table.add_row(*finding)
    return table


def need(holds: bool, otherwise: str) -> None:
    """Raises NotSoError."""
    if not holds:
        raise NotSoError(otherwise)
