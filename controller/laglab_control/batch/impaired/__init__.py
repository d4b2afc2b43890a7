"""Many robots on links that lose, delay at random, reorder, and fall silent.

What happens when is the same whatever the robots do (`Timetable`); by it the numbers of all of them
are computed at once.
"""

from laglab_control.batch.impaired.controller import IMPAIRED, Answers, ImpairedController
from laglab_control.batch.impaired.timetable import (
    Arrivals,
    Course,
    Missing,
    News,
    Timetable,
    Tokens,
)

__all__ = [
    "IMPAIRED",
    "Answers",
    "Arrivals",
    "Course",
    "ImpairedController",
    "Missing",
    "News",
    "Timetable",
    "Tokens",
]
