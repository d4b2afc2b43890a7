"""A study, computed: every cell that is not there yet, by whoever does jobs."""

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError, Future
from contextlib import nullcontext
from pathlib import Path
from tempfile import mkdtemp

from laglab.errors import LaglabError, RunError, WorkerDiedError
from laglab.progress import progress_of_study
from laglab.studies.sweep.cells.cell import Cell
from laglab.studies.sweep.cells.tasks import Task, done, grouped, one_by_one
from laglab.studies.sweep.cells.ways import seconds
from laglab.studies.sweep.cluster import is_killed_worker
from laglab.studies.sweep.folder import Folder
from laglab.studies.sweep.loading import load_study
from laglab.studies.sweep.result import StudyResult
from laglab.studies.sweep.study import Study
from laglab.studies.sweep.work import Work, checked_work
from laglab.studies.workers import Executor, Processes, as_done

Contents = list[bytes | str]
AHEAD = 512
"""Tasks that are handed out at once: as many as a large cluster has hands, and no more, so that
memory always has room."""


def swept(
    study: Study | str | Path,
    executor: Executor | None,
    out: str | Path | None,
    progress: bool,
    limit: int,
) -> StudyResult:
    """As `sweep` says."""
    chosen = study if isinstance(study, Study) else load_study(str(study))
    work = checked_work(chosen, None if out is None else Folder(Path(out)), limit)
    if out is None:
        folder = Folder.made(Path(mkdtemp(prefix="laglab-")), chosen)
        result = StudyResult.passing(chosen, folder, chosen.origin)
    else:
        folder = Folder.made(Path(out), chosen)
        result = StudyResult(chosen, folder, chosen.origin)
    with Processes(0) if executor is None else nullcontext(executor) as workers:
        work_off(chosen.name, chosen.cells(), folder, workers, work, progress)
    return result


def work_off(
    name: str,
    cells: Iterable[Cell],
    folder: Folder,
    executor: Executor,
    work: Work,
    progress: bool = True,
    again: bool = False,
) -> None:
    """Do the work that is left of the cells, or all of it `again`. Raises as `compute`."""
    with progress_of_study(name, work.runs, work.seconds, progress) as told:
        # Looked for when it is its turn: somebody else may have computed it meanwhile.
        wanted = (cell for cell in cells if again or not folder.has(cell))
        compute(name, wanted, folder, executor, told)


def compute(
    name: str,
    cells: Iterable[Cell],
    folder: Folder,
    executor: Executor,
    told: Callable[[int, float], None],
) -> None:
    """The cells, into the folder; `told` of each, its runs and cost.

    A run that fails is no reason to leave out the others: what failed is said at the end.
    Raises: RunError, ResultsError. What had been done until then stays.
    """
    failed: list[str] = []
    for task, contents in _answers(name, grouped(cells), executor):
        for cell, content in zip(task.cells, contents, strict=True):
            if isinstance(content, str):
                failed.append(content)
                continue
            folder.keep(cell, content)
            told(len(cell.seeds), seconds(cell))
    if failed:
        others = f" (and {len(failed) - 1} more such)" if failed[1:] else ""
        raise RunError(
            f"{name}: {failed[0]}{others}: all else that is done is kept, and the same "
            "command goes on from there"
        )


def _answers(
    name: str, tasks: Iterable[Task], executor: Executor
) -> Iterator[tuple[Task, Contents]]:
    """Of all, as they are done. Those whose worker died are done once more at the end, cell by
    cell and one at a time: so it is seen which of them it dies of."""
    suspects: list[Task] = []
    for task, future in as_done(executor, done, tasks, AHEAD):
        try:
            contents = _contents(name, future)
        except WorkerDiedError:
            suspects += one_by_one(task)
        else:
            yield task, contents
    for task, future in as_done(executor, done, suspects, ahead=1):
        try:
            contents = _contents(name, future)
        except WorkerDiedError as error:
            contents = [f"{task.cells[0].place}: {error}"]
        yield task, contents


def _contents(name: str, future: "Future[Contents]") -> Contents:
    """What a task came to. Raises WorkerDiedError, and RunError: whoever does the work is gone."""
    try:
        return future.result()
    except LaglabError:
        raise
    except (Exception, CancelledError) as error:  # whatever an executor may say
        if is_killed_worker(error):
            raise WorkerDiedError(str(error)) from error
        raise RunError(
            f"{name}: whoever was to do the rest failed or is gone ({error!r}): what is "
            "done is kept, and the same command goes on from there"
        ) from error
