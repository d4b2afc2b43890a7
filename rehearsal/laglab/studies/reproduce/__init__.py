"""The paper's figures and claims, each with what a run says to it."""

from laglab.studies.reproduce.claim import Claim, Evidence, Finding, Verdict
from laglab.studies.reproduce.claims import CLAIMS, tried, trying
from laglab.studies.reproduce.entry import Entry, entries
from laglab.studies.reproduce.report import write_report

__all__ = [
    "CLAIMS",
    "Claim",
    "Entry",
    "Evidence",
    "Finding",
    "Verdict",
    "entries",
    "tried",
    "trying",
    "write_report",
]
