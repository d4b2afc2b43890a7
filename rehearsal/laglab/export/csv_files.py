"""Tables as CSV files: numbers that read back to the same double, empty where there is nothing."""

from collections.abc import Iterator
from typing import BinaryIO

from laglab.export.tables import Table
from laglab_gateway import format_row


def write_csv(table: Table, file: BinaryIO) -> None:
    """The header, and a line a row."""
    file.write(format_row(tuple(column.name for column in table.columns)).encode())
    for row in _rows(table):
        file.write(format_row(row).encode())


def _rows(table: Table) -> Iterator[tuple[int | float | str | None, ...]]:
    for piece in table.pieces:
        yield from zip(*(map(_cell, column.tolist()) for column in piece.values()), strict=True)


def _cell(value: int | float | str) -> int | float | str | None:
    return None if value != value else value
