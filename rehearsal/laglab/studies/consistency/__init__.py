"""Whether the covariance that a filter claims is the one its error has, over many seeds."""

from laglab.studies.consistency.judging import Job, Sample, judge, judged, nth, samples
from laglab.studies.consistency.over_seeds import chi_square_bounds, consistencies
from laglab.studies.consistency.report import consistency_table, draw_consistency, unjudged

__all__ = [
    "Job",
    "Sample",
    "chi_square_bounds",
    "consistencies",
    "consistency_table",
    "draw_consistency",
    "judge",
    "judged",
    "nth",
    "samples",
    "unjudged",
]
