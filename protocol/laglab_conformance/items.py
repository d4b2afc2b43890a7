"""Items, and how they are carried out one after another."""

import statistics
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Generic, TypeVar

from laglab_conformance.forge import Forged
from laglab_conformance.report import Mark, Result
from laglab_conformance.session import DoesNotApplyError, NoReactionError, Session, Waits
from laglab_protocol import DIALECT_VERSION, End, EndpointError, EndReason, Settings

SOON = 0.25
"""[s] Within this time a peer in lock-step reacts."""

AnySession = TypeVar("AnySession", bound=Session, contravariant=True)


@dataclass(frozen=True)
class Item(Generic[AnySession]):
    """`check` returns what is wrong, None when nothing is. It may raise NoReactionError and
    DoesNotApplyError."""

    group: str
    name: str
    check: Callable[[AnySession], str | None]
    mandatory: bool = True


def carry_out(
    items: Iterable[Item[AnySession]], session: AnySession, progress: Callable[[str], None]
) -> tuple[Result, ...]:
    """Every item in its turn; one that fails does not keep the others from being tried.

    Only where the first fails, that the peer is there at all, are the others not tried; nor are
    they after Ctrl-C, when the peer is told that its run is over. `progress` is told what is tried.
    """
    results: list[Result] = []
    waiting = list(items)
    try:
        while waiting:
            progress(f"{waiting[0].group}: {waiting[0].name}")
            results.append(_result(waiting[0], session))
            del waiting[0]
            if results[0].mark is Mark.FAILED:
                no_talk = "not tried: without the first there is no talk"
                return results[0], *(_left_out(item, Mark.SKIPPED, no_talk) for item in waiting)
    except KeyboardInterrupt:
        session.leave()
    return *results, *(_left_out(item, Mark.INTERRUPTED, "") for item in waiting)


def _left_out(item: Item[AnySession], mark: Mark, why: str) -> Result:
    return Result(item.group, item.name, item.mandatory, mark, why, 0.0)


def _result(item: Item[AnySession], session: AnySession) -> Result:
    started, ended = time.monotonic(), session.ended
    mark, reason = Mark.PASSED, ""
    try:
        wrong = item.check(session)
        if wrong is not None:
            mark, reason = Mark.FAILED, wrong
    except NoReactionError as error:
        mark, reason = Mark.FAILED, str(error)
    except DoesNotApplyError as error:
        mark, reason = Mark.SKIPPED, str(error)
    except EndpointError:
        raise
    except Exception as error:  # whatever a stranger says, the other items are tried
        mark, reason = Mark.FAILED, f"nothing can be made of what it says: {error!r}"
    if mark is Mark.FAILED and ended:
        reason += f" (its run had ended at tick {ended.tick}: {_advice(ended)})"
    seconds = time.monotonic() - started
    return Result(item.group, item.name, item.mandatory, mark, reason, seconds)


def _advice(ended: End) -> str:
    return "let it run longer" if ended.reason == EndReason.COMPLETED else "it gave us up"


def reacts_soon(session: Session) -> str | None:
    """The median of nine ordinary exchanges must be over within `SOON`."""
    if session.waits.react > Waits().react:
        raise DoesNotApplyError(f"it is given {session.waits.react:g} s for everything")
    times = []
    for _ in range(9):
        started = time.monotonic()
        session.exchange()
        times.append(time.monotonic() - started)
    median = statistics.median(times)
    return f"median {median:.3f} s" if median > SOON else None


def wrongly_told(told: Settings) -> str | None:
    """What is wrong with its settings, whoever's they are."""
    if not told.sample_time > 0:
        return f"its sample time is {told.sample_time}"
    if told.dialect != DIALECT_VERSION:
        return f"it speaks version {told.dialect} of the dialect, the kit {DIALECT_VERSION}"
    return None


S = TypeVar("S", bound=Session)


def accepted(mangle: Callable[[S, Forged], bytes]) -> Callable[[S], str | None]:
    """The stimulus in this form must be taken; if it was not, the ordinary one comes after it."""

    def check(session: S) -> str | None:
        session.endpoint.send(mangle(session, session.forged()))
        if session.reacts(session.waits.react):
            return None
        session.exchange()
        return "it was not taken"

    return check


def refused(mangle: Callable[[S, Forged], bytes]) -> Callable[[S], str | None]:
    """The stimulus in this form must not be taken, and the ordinary one after it must."""

    def check(session: S) -> str | None:
        session.endpoint.send(mangle(session, session.forged()))
        if session.reacts(session.refusal):
            return "it was taken"
        session.exchange()
        return None

    return check
