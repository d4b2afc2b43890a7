"""What a sweep left in a folder, as the runs to be drawn."""

from pathlib import Path

from laglab.studies.maps.runs import StudyRuns, runs_of


def read_runs(folder: Path) -> StudyRuns:
    """All that has been computed of a study. Needs pyarrow.

    Raises: NoRunError, StudyError, ScenarioError.
    """
    from laglab.studies.sweep.result import open_study  # whoever draws nothing does without

    result = open_study(folder)
    table = result.table
    columns = {name: table[name].to_numpy() for name in table.column_names}
    return runs_of(columns, result.study.grid, folder.resolve().name, result.study.scenario)
