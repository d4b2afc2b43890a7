"""Studies from Python; what the extra brings is not loaded before it is known to be there."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from laglab.extras import STUDYING, require
from laglab.studies.sweep.work import MOST_RUNS

if TYPE_CHECKING:
    from laglab.studies.sweep.result import StudyResult
    from laglab.studies.sweep.study import Study
    from laglab.studies.workers import Executor


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
        MissingExtraError: the extra `study` is not installed.
        StudyError, ScenarioError: there is no such study, or it cannot be.
        PlaceError: the results cannot go there.
        RunError, ResultsError: something broke on the way; what was done is in `out`.
        KeyboardInterrupt: Ctrl-C; likewise.
    """
    require(STUDYING)
    from laglab.studies.sweep.sweeping import swept

    return swept(study, executor, out, progress, limit)


def open_study(directory: str | Path) -> StudyResult:
    """What a sweep left in a folder, whatever code is here by now.

    Raises: MissingExtraError, NoRunError, StudyError, ScenarioError.
    """
    require(STUDYING)
    from laglab.studies.sweep.result import opened

    return opened(Path(directory))
