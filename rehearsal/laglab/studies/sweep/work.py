"""What a study asks for: known, and checked, before anything runs."""

from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

from pydantic import ValidationError

from laglab.errors import ScenarioError, StudyError
from laglab.runs.errors import SIDE_ERRORS
from laglab.runs.plant import check_plant
from laglab.runs.station_side import check_parts
from laglab.scenario.problems import first_problem
from laglab.studies.sweep.cells.cell import Cell
from laglab.studies.sweep.cells.ways import How, how, seconds
from laglab.studies.sweep.study import Study

if TYPE_CHECKING:
    from laglab.studies.sweep.folder import Folder

MOST_RUNS = 1_000_000
"""More than that are run only when somebody says that they are meant."""
PARTS = {"plant", "estimator", "law", "sample_time"}
"""Of a scenario what somebody may have brought, and is tried once, before anything runs."""


class Work(NamedTuple):
    """What is still to be done, summed up."""

    ways: Counter[How]
    """How many runs are to be made which way."""
    seconds: float
    """About how long they take, on one core."""

    @property
    def runs(self) -> int:
        """How many are still to be done."""
        return self.ways.total()


def work_left(*studies: Study, folder: "Folder | None" = None) -> Work:
    """The studies' cells that are not in the folder, summed up. Raises StudyError: a cell, in the
    folder or not, cannot be run."""
    ways: Counter[How] = Counter()
    cost = 0.0
    tried = set[str]()
    for study in studies:
        for cell in study.cells():
            check(study, cell)
            parts = cell.scenario.model_dump_json(include=PARTS)
            if parts not in tried:
                tried.add(parts)
                _check_parts(study, cell)
            if folder is None or not folder.has(cell):
                ways[how(cell)] += len(cell.seeds)
                cost += seconds(cell)
    return Work(ways, cost)


def _check_parts(study: Study, cell: Cell) -> None:
    """Raises StudyError: its plant, its filter or its law cannot be had, or not with these keys."""
    try:
        check_plant(cell.scenario)
        check_parts(cell.scenario)
    except SIDE_ERRORS as error:
        raise StudyError(f"{study.name}: with {cell.place}: {error}") from None


def checked_work(study: Study, folder: "Folder | None", limit: int = MOST_RUNS) -> Work:
    """The same, of no more runs than `limit`. Raises StudyError."""
    if study.runs > limit:
        raise StudyError(
            f"{study.name}: {study.runs} runs ({study.points} points of the grid, "
            f"{len(study.seeds)} seeds), more than the limit of {limit}: take fewer values, or say "
            f"--limit {study.runs}"
        )
    return work_left(study, folder=folder)


def check(study: Study, cell: Cell) -> None:
    """Raises StudyError: the scenario cannot be, or not be run again alike."""
    try:
        pace = cell.scenario.pace
        cell.scenario.must_end()
    except ValidationError as error:
        raise StudyError(f"{study.name}: with {cell.place}: {first_problem(error)}") from None
    except ScenarioError as error:
        raise StudyError(f"{study.name}: with {cell.place}: {error}") from None
    if pace != "lockstep":
        raise StudyError(
            f"{study.name}: pace: must be lockstep in a study, whose runs come out the same "
            f"whenever they are made, not {pace}"
        )
