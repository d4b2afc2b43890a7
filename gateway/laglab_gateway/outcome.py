"""How a run ended."""

from typing import NamedTuple

from laglab_protocol import End, EndReason


class Outcome(NamedTuple):
    """How a run ended, and at which tick."""

    reason: EndReason
    tick: int


def reason_of(end: End) -> EndReason:
    """Why a peer ended the run; a reason we do not know counts as a failure."""
    return EndReason(end.reason) if end.reason in set(EndReason) else EndReason.FAILED
