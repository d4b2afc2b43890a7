"""Tables as Parquet files, whose columns say their units."""

from typing import BinaryIO

import pyarrow
from pyarrow.parquet import ParquetWriter

from laglab.export.tables import Table
from laglab.results.meaning import Column
from laglab.results.run import Run

TYPES = {int: pyarrow.int64(), float: pyarrow.float64(), str: pyarrow.string()}


def write_parquet(table: Table, run: Run, file: BinaryIO) -> None:
    """Each column with `unit` and `description` in its metadata, the file with `scenario`; null
    where there is nothing."""
    schema = pyarrow.schema(
        [_field(column) for column in table.columns],
        {"laglab": run.summary.laglab, "scenario": run.scenario.to_toml()},
    )
    with ParquetWriter(file, schema) as writer:
        for piece in table.pieces:
            columns = [pyarrow.array(column, from_pandas=True) for column in piece.values()]
            writer.write_table(pyarrow.Table.from_arrays(columns, schema=schema))


def _field(column: Column) -> pyarrow.Field:
    about = {"unit": column.unit, "description": column.sentence}
    return pyarrow.field(column.name, TYPES[column.kind], metadata=about)
