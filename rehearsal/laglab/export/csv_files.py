"""Tables as CSV files: numbers that read back to the same double, empty where there is nothing."""

from typing import BinaryIO

from laglab.export.tables import Table
from laglab_gateway import csv_header, csv_lines


def write_csv(table: Table, file: BinaryIO) -> None:
    """The header, and a line a row."""
    file.write(csv_header(column.name for column in table.columns))
    for piece in table.pieces:
        columns = (map(_cell, column.tolist()) for column in piece.values())
        file.write(csv_lines(list(zip(*columns, strict=True))))


def _cell(value: int | float | str) -> int | float | str | None:
    return None if value != value else value
