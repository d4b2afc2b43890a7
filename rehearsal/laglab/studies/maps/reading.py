"""A study's folder, as the runs to be drawn."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from pydantic import ValidationError

from laglab.errors import ScenarioError, StudyError
from laglab.scenario import Scenario, load
from laglab.scenario.toml import parsed
from laglab.studies.maps.runs import StudyRuns, runs_of

if TYPE_CHECKING:
    import pyarrow

STUDY_FILE = "study.toml"
CELLS = "cells"
OURS = ("converged", "seed")
"""Columns that every cell has."""


def read_runs(folder: Path) -> StudyRuns:
    """All that has been computed of a study. Needs pyarrow.

    Raises: StudyError, when the folder is no study's, or nothing is there yet.
    """
    try:
        study = parsed((folder / STUDY_FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise StudyError(f"{folder} is not a study's folder: no {STUDY_FILE} to read") from error
    grid = study.get("grid", {})
    table = _joined(folder, (*grid, *OURS))
    columns = {name: table[name].to_numpy() for name in table.column_names}
    return runs_of(columns, grid, folder.name, _base(study.get("scenario")))


def _joined(folder: Path, columns: tuple[str, ...]) -> pyarrow.Table:
    import pyarrow

    tables = [_cell(path, columns) for path in sorted((folder / CELLS).glob("*.parquet"))]
    if not tables:
        raise StudyError(f"{folder}: no cell of this study has been computed yet")
    return pyarrow.concat_tables(tables, promote_options="permissive")


def _cell(path: Path, columns: tuple[str, ...]) -> pyarrow.Table:
    import pyarrow
    from pyarrow import parquet

    try:
        table = parquet.read_table(path)
    except (OSError, pyarrow.ArrowException) as error:
        raise StudyError(f"{path} is not a Parquet file that can be read") from error
    if missing := [name for name in columns if name not in table.column_names]:
        raise StudyError(f"{path} is not a cell of this study: it has no column {missing[0]!r}")
    return table


def _base(scenario: object) -> Scenario | None:
    """None: it is not to be had any more, and the map is drawn without the margin."""
    try:
        if isinstance(scenario, str):
            return load(scenario)
        return Scenario.model_validate(scenario)
    except (ScenarioError, ValidationError):
        return None
