"""What a sweep left in a folder, as the runs to be drawn."""

from pathlib import Path

from laglab.errors import NoRunError
from laglab.studies.maps.runs import StudyRuns, runs_of

OURS = ("converged", "seed")


def read_runs(folder: Path) -> StudyRuns:
    """All that has been computed of a study. Needs pyarrow.

    Raises: NoRunError, StudyError, ScenarioError.
    """
    from laglab.studies.sweep.cells.compute import column_value  # needs pyarrow
    from laglab.studies.sweep.interface import open_study

    result = open_study(folder)
    table = result.table
    if missing := {*result.study.grid, *OURS} - {*table.column_names}:
        raise NoRunError(
            f"{folder} holds what is not a cell of this study: it has no column {min(missing)!r}"
        )
    columns = {name: table[name].to_numpy() for name in table.column_names}
    grid = {key: [column_value(v) for v in values] for key, values in result.study.grid.items()}
    return runs_of(columns, grid, folder.resolve().name, result.study.scenario)
