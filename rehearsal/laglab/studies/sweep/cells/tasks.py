"""What a worker is given at once: as many cells as are worth the way there and back."""

import io
from collections.abc import Iterable, Iterator

import pyarrow as pa
import pyarrow.parquet as pq
from msgspec import Struct

from laglab.errors import RunError
from laglab.studies.sweep.cells.cell import Cell
from laglab.studies.sweep.cells.compute import computed
from laglab.studies.sweep.cells.ways import crowd, seconds
from laglab.version import code_version

WORTHWHILE = 0.1
"""[s] The least that a task takes, where there are cells enough."""
MOST_CELLS = 100


class Task(Struct, frozen=True):
    """Some cells, to be computed by the same code as that of whoever wants them."""

    cells: tuple[Cell, ...]
    code: str


def grouped(cells: Iterable[Cell]) -> Iterator[Task]:
    """In their order. Raises: ScenarioError."""
    some: list[Cell] = []
    cost, robots = 0.0, 0
    for cell in cells:
        some.append(cell)
        cost, robots = cost + seconds(cell), robots + len(cell.seeds)
        if (cost >= WORTHWHILE and robots >= crowd(cell)) or len(some) == MOST_CELLS:
            yield Task(tuple(some), code_version())
            some, cost, robots = [], 0.0, 0
    if some:
        yield Task(tuple(some), code_version())


def done(task: Task) -> list[bytes | str]:
    """Wherever it is done: each cell's table, as the contents of a Parquet file; or why a run of it
    failed.

    The same bytes for the same cell, as far as pyarrow is the same. Raises RunError: the code is
    another one.
    """
    if task.code != code_version():
        raise RunError(
            f"a worker has laglab {code_version()}, not {task.code} as here: install the same there"
        )
    try:
        return [_file(table) for table in computed(task.cells)]
    except RunError as error:
        if len(task.cells) == 1:
            return [str(error)]
    except Exception as error:  # of what others brought, and nobody foresaw
        if len(task.cells) == 1:
            return [f"{task.cells[0].place}: {error!r}"]
    return [each for one in one_by_one(task) for each in done(one)]


def one_by_one(task: Task) -> list[Task]:
    """The same, a task a cell."""
    return [Task((cell,), task.code) for cell in task.cells]


def _file(table: pa.Table) -> bytes:
    out = io.BytesIO()
    pq.write_table(table, out)
    return out.getvalue()
