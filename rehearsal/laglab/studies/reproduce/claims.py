"""All claims, in the paper's order, and how they are tried.

To add one, put it into the table of its file.
"""

from collections.abc import Iterator, Sequence

from laglab.studies.reproduce import figures, filters, law, many
from laglab.studies.reproduce.claim import Claim, Finding
from laglab.studies.workers import shared_out

CLAIMS: dict[str, Claim] = {
    claim.name: claim
    for table in (law.CLAIMS, filters.CLAIMS, figures.CLAIMS, many.CLAIMS)
    for claim in table
}
LONGEST = ("starts-noise", "covariance", "starts", "prior", "prior-below-r", "optimal", "fig8")
"""Begun first, so that no worker is left with one at the end."""


def trying(names: Sequence[str], workers: int) -> Iterator[Finding]:
    """Each of the claims, as they are done. Raises RunError."""
    ordered = sorted(names, key=lambda name: (name not in LONGEST, names.index(name)))
    return shared_out(tried, ordered, workers)


def tried(name: str) -> Finding:
    """In a worker: one claim."""
    return Finding(name, CLAIMS[name].experiment())
