"""Whether the covariance that a filter claims is the one its error has, over many seeds."""

from laglab.studies.consistency.judging import (
    Job,
    Sample,
    chi_square_bounds,
    judge,
    judged,
    nth,
    samples,
    verdict,
)
from laglab.studies.consistency.report import consistency_table, draw_consistency

__all__ = [
    "Job",
    "Sample",
    "chi_square_bounds",
    "consistency_table",
    "draw_consistency",
    "judge",
    "judged",
    "nth",
    "samples",
    "verdict",
]
