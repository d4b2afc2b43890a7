"""A study, computed: every cell that is not there yet, by whoever does jobs."""

import os
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from tempfile import TemporaryDirectory

from laglab.errors import LaglabError, RunError
from laglab.extras import STUDYING, require
from laglab.progress import progress_of_study
from laglab.studies.sweep.cell import Cell
from laglab.studies.sweep.folder import Folder
from laglab.studies.sweep.loading import load_study
from laglab.studies.sweep.plan import MOST_RUNS, check_size, planned
from laglab.studies.sweep.result import StudyResult
from laglab.studies.sweep.study import Study
from laglab.studies.sweep.tasks import done, grouped
from laglab.studies.sweep.ways import seconds
from laglab.studies.workers import Executor, Processes, as_done

AHEAD = 64
"""Tasks that are handed out at once, whether anybody has a hand free or not."""


def sweep(
    study: Study | str | Path,
    executor: Executor | None = None,
    out: str | Path | None = None,
    progress: bool = False,
    *,
    limit: int = MOST_RUNS,
) -> StudyResult:
    """Have a study computed, given itself, by its shipped name or by its file.

    Args:
        executor: who does the jobs, as those of `concurrent.futures` do; None: processes of our
            own, one a core, which are gone at the end.
        out: the folder for the results; what it has of the study already is not computed again.
            None keeps them in a temporary one, as long as the result is kept.
        progress: show it on standard error.
        limit: the most runs that are meant.

    Raises:
        StudyError, ScenarioError: there is no such study, or it cannot be.
        PlaceError: the results cannot go there.
        RunError, ResultsError: something broke on the way; what was done is in `out`.
        KeyboardInterrupt: Ctrl-C; likewise.
    """
    require(STUDYING)
    chosen = study if isinstance(study, Study) else load_study(str(study))
    check_size(chosen, limit)
    planned(chosen)
    temporary = TemporaryDirectory(prefix="laglab-") if out is None else None
    folder = Folder.made(Path(temporary.name if temporary else str(out)), chosen)
    plan = planned(chosen, folder)
    with (
        progress_of_study(chosen.name, plan.runs, plan.seconds, progress) as told,
        own_processes() if executor is None else nullcontext(executor) as workers,
    ):
        compute(chosen, folder, workers, told)
    return StudyResult(chosen, folder, chosen.origin, temporary)


def own_processes(workers: int = 0) -> AbstractContextManager[Processes]:
    """So many; 0: one a core."""
    return Processes(workers or os.cpu_count() or 1)


def compute(
    study: Study,
    folder: Folder,
    executor: Executor,
    told: Callable[[int, float], None],
    again: bool = False,
) -> None:
    """The cells that are not there, or all of them `again`; `told` of each, its runs and cost.

    Raises: RunError, ResultsError. What had been done until then stays.
    """

    def wanted() -> Iterator[Cell]:
        """Looked for when it is its turn: somebody else may have computed it meanwhile."""
        return (cell for cell in study.cells() if again or not folder.has(cell))

    for task, future in as_done(executor, done, grouped(wanted()), AHEAD):
        try:
            contents = future.result()
        except LaglabError:
            raise
        except Exception as error:  # whatever an executor that is not ours may say
            raise RunError(f"{study.name}: the workers are lost: {error!r}") from error
        for cell, content in zip(task.cells, contents, strict=True):
            folder.keep(cell, content)
            told(len(cell.seeds), seconds(cell))
