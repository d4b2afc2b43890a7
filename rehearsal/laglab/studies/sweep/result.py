"""What there is of a study."""

from __future__ import annotations

import shutil
import weakref
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pyarrow as pa

from laglab.errors import StudyError
from laglab.studies.sweep.folder import Folder
from laglab.studies.sweep.study import Study

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True, eq=False)
class StudyResult:
    """A row for every run that has been made, in the order of the grid and of the seeds."""

    study: Study
    folder: Folder
    origin: str

    @classmethod
    def passing(cls, study: Study, folder: Folder, origin: str) -> StudyResult:
        """One whose folder goes when it goes."""
        result = cls(study, folder, origin)
        weakref.finalize(result, shutil.rmtree, folder.path, ignore_errors=True)
        return result

    @property
    def directory(self) -> Path:
        """Where its files are."""
        return self.folder.path

    @property
    def missing(self) -> int:
        """How many cells have not been computed."""
        return sum(not self.folder.has(cell) for cell in self.study.cells(self.origin))

    def tables(self, columns: list[str] | None = None) -> Iterator[pa.Table]:
        """Cell by cell, so that memory always has room. Raises NoRunError."""
        return self.folder.tables(self.study.cells(self.origin), columns)

    @property
    def table(self) -> pa.Table:
        """All rows, as one pyarrow.Table. Raises NoRunError."""
        return self.folder.table_of(self.study.cells(self.origin))

    def to_pandas(self) -> pandas.DataFrame:
        """All rows. Needs pandas. Raises NoRunError."""
        return self.table.to_pandas()

    def map(self, x: str, y: str, value: str) -> pandas.DataFrame:
        """A row for each value of the column `y`, a column for each of `x`; there, the mean of
        `value` over the rest of the grid and the seeds, of a column of yes or no the share of yes.

        Needs pandas. Raises: NoRunError; StudyError: there is no such column.
        """
        columns = [x, y, value]
        self._check(columns)
        cells = self.study.cells(self.origin)
        frame = self.folder.table_of(cells, sorted(set(columns))).to_pandas()
        frame[value] = frame[value].astype(float)
        return frame.pivot_table(index=y, columns=x, values=value, aggfunc="mean", dropna=False)

    def _check(self, columns: list[str]) -> None:
        """Raises StudyError: there is no such column in the first table, which is like all."""
        some = next(self.tables(), None)
        known = [] if some is None else some.column_names
        for name in columns:
            if some is not None and name not in known:
                raise StudyError(
                    f"{self.study.name}: no column {name!r}; there are {', '.join(known)}"
                )


def opened(directory: Path) -> StudyResult:
    """As `open_study` says."""
    folder = Folder(directory)
    study, origin = folder.study()
    return StudyResult(study, folder, origin or study.origin)
