"""A study's folder: `study.toml`, and a file for every cell that has been computed.

A cell's file is named by its key, never changes, and is there whole or not at all. So what is still
to be done is what has no file, and whoever works on the same folder at once does no harm.
"""

import os
import time
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import msgspec
import pyarrow as pa
import pyarrow.parquet as pq

from laglab.errors import NoRunError, PlaceError
from laglab.files import BESIDE, folder_place, write_whole
from laglab.results.summary import STUDY_CELLS, STUDY_FILE, SUMMARY_FILE
from laglab.studies.sweep.cells.cell import Cell
from laglab.studies.sweep.cells.compute import DESCRIPTION
from laglab.studies.sweep.loading import study_of, to_toml
from laglab.studies.sweep.study import Study

ABANDONED = 3600.0
"""[s] A file half written longer ago than this nobody will finish."""


@dataclass(frozen=True)
class Folder:
    """Where a study's cells are kept."""

    path: Path

    @classmethod
    def of_cells(cls, path: Path, option: str = "--out") -> "Folder":
        """For cells, whatever they are of; what is there stays. Raises PlaceError."""
        folder_place(option, path)
        if (path / SUMMARY_FILE).exists():
            raise PlaceError(f"{option} {path}: a run's results are there: take another folder")
        folder = cls(path)
        for half in folder_place(option, folder.cells).glob(BESIDE):
            with suppress(OSError):
                if time.time() - half.stat().st_mtime > ABANDONED:
                    half.unlink()
        return folder

    @classmethod
    def made(cls, path: Path, study: Study) -> "Folder":
        """For the study, from now on; what is there stays. Raises: PlaceError, ResultsError."""
        folder = cls.of_cells(path)
        text = to_toml(study, study.origin)
        if not (folder._study.is_file() and folder._study.read_bytes() == text.encode()):
            write_whole(folder._study, text, lasting=True)
        return folder

    @property
    def cells(self) -> Path:
        """The folder of their files."""
        return self.path / STUDY_CELLS

    @property
    def _study(self) -> Path:
        return self.path / STUDY_FILE

    def study(self) -> tuple[Study, str]:
        """What it is of, and the origin of its cells. Raises: NoRunError, StudyError."""
        try:
            text = self._study.read_text(encoding="utf-8")
        except (OSError, ValueError) as error:
            said = getattr(error, "strerror", None) or error
            raise NoRunError(f"{self._study} cannot be read: {said}") from error
        return study_of(text, str(self._study), self.path / f"{self.path.resolve().name}.toml")

    def file(self, cell: Cell) -> Path:
        """Where it is, or would be."""
        return self.cells / f"{cell.key}.parquet"

    def has(self, cell: Cell) -> bool:
        """Whether it has been computed; not where nobody may look."""
        return os.path.isfile(self.file(cell))  # noqa: PTH113 Path.is_file raises there

    def runs(self, cells: Iterable[Cell]) -> int:
        """How many of theirs have been made."""
        return sum(len(cell.seeds) for cell in cells if self.has(cell))

    def keep(self, cell: Cell, content: bytes) -> None:
        """For good. Raises ResultsError."""
        write_whole(self.file(cell), content, lasting=True)

    def strangers(self, cells: Iterable[Cell]) -> list[Path]:
        """The files that are of none of these cells."""
        theirs = {path.name for path in self.cells.glob("*.parquet")}
        for cell in cells:
            theirs.discard(self.file(cell).name)
        return sorted(self.cells / name for name in theirs)

    def place_of(self, path: Path) -> str:
        """Where in its grid the cell of a file is, and which file."""
        try:
            told = msgspec.json.decode(pq.read_schema(path).metadata[DESCRIPTION])
        except (OSError, pa.ArrowException, KeyError, TypeError, msgspec.DecodeError):
            return path.name
        there = ", ".join(f"{key} = {value}" for key, value in told["grid"].items())
        return f"{path.name} ({there})" if there else path.name

    def table(self, cell: Cell, columns: list[str] | None = None) -> pa.Table:
        """Of one that is there. Raises NoRunError."""
        path = self.file(cell)
        try:
            return pq.read_table(path, columns=columns, partitioning=None)
        except (OSError, pa.ArrowException) as error:
            raise NoRunError(
                f"{path} cannot be read: {error}: delete it, and sweep again"
            ) from error

    def tables(self, cells: Iterable[Cell], columns: list[str] | None = None) -> Iterator[pa.Table]:
        """Of those that are there, one after the other. Raises NoRunError."""
        return (self.table(cell, columns) for cell in cells if self.has(cell))

    def table_of(self, cells: Iterable[Cell], columns: list[str] | None = None) -> pa.Table:
        """All their rows. Raises NoRunError, also when there is none."""
        tables = list(self.tables(cells, columns))
        if not tables:
            raise NoRunError(f"{self.path}: no cell of this study has been computed")
        return pa.concat_tables(tables)
