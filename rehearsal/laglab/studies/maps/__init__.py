"""Pictures of a study: a table of its runs in, a figure out."""

from laglab.studies.maps.drawing import draw_study
from laglab.studies.maps.reading import read_runs
from laglab.studies.maps.runs import StudyRuns, runs_of

__all__ = ["StudyRuns", "draw_study", "read_runs", "runs_of"]
