"""What a report says of one claim."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from laglab.studies.reproduce.claim import Claim, Finding, Verdict
from laglab.studies.reproduce.claims import CLAIMS

TITLE = "The paper's claims, reproduced"
SIGNS = {
    Verdict.HOLDS: "✓",
    Verdict.LIMITED: "±",
    Verdict.HARMLESS: "○",
    Verdict.FAILS: "✗",
}


class Entry(NamedTuple):
    """A claim that was tried, in words."""

    claim: Claim
    verdict: Verdict
    spelled: str
    """The verdict, with its condition if it has one."""
    got: str
    picture: bytes
    """PNG; empty without one."""

    @property
    def sign(self) -> str:
        """The verdict in one character."""
        return SIGNS[self.verdict]


def entries(findings: Sequence[Finding]) -> list[Entry]:
    """In the paper's order."""
    order = list(CLAIMS)
    return [_entry(each) for each in sorted(findings, key=lambda each: order.index(each.name))]


def _entry(finding: Finding) -> Entry:
    claim, numbers = CLAIMS[finding.name], finding.evidence.numbers
    verdict = claim.verdict(numbers)
    got = claim.got.format(**numbers)
    return Entry(claim, verdict, claim.spelled(verdict), got, finding.evidence.picture)


def opening(of: Sequence[Entry]) -> str:
    """What the report is, in a paragraph."""
    counts = {each: sum(entry.verdict is each for entry in of) for each in Verdict}
    return (
        f"Of {len(of)} claims of its theory and simulation sections {counts[Verdict.HOLDS]} hold, "
        f"{counts[Verdict.LIMITED]} hold with a condition, {counts[Verdict.HARMLESS]} are "
        f"misprints that do not show, and {counts[Verdict.FAILS]} do not hold. Each was tried by "
        "runs, and the command beside it shows one of them. What the paper says is told in our "
        "words; a number in brackets is its equation."
    )
