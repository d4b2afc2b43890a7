"""Where a run's results go."""

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from laglab.errors import PlaceError
from laglab.files import folder_place
from laglab.results.figures import FIGURE_FILE
from laglab.results.run import SCENARIO_FILE
from laglab.results.summary import STUDY_CELLS, STUDY_FILE, SUMMARY_FILE
from laglab.scenario import Scenario
from laglab_gateway import ROWS, TLOG_FILE, TRACE_FILE

REPORT_FILE = "report.html"
OURS = (SCENARIO_FILE, SUMMARY_FILE, TRACE_FILE, TLOG_FILE, *ROWS, FIGURE_FILE, REPORT_FILE)


def place(scenario: Scenario, out: Path | None, force: bool = False, suffix: str = "") -> Path:
    """The folder for the run's results, made and writable, the scenario already in it.

    Without `out` a new one, `runs/SCENARIO` or with a number behind it; an explicit one that holds
    another run's results is taken only with `force`. Raises PlaceError.
    """
    if out is None:
        directory = fresh(Path("runs"), re.sub(r"[^\w.-]", "-", scenario.name + suffix))
    else:
        directory = folder_place("--out", out)
        otherwise = "take another folder, or say --force (in Python force=True)"
        _refuse_taken(out, () if force else OURS, otherwise)
    try:
        shadows = directory.glob("shadow-*.csv")
        for old in [*(directory / name for name in OURS), *shadows]:
            old.unlink(missing_ok=True)
        text = scenario.to_toml(directory)
        (directory / SCENARIO_FILE).write_text(text, encoding="utf-8")
    except OSError as error:
        with suppress(OSError):
            (directory / SCENARIO_FILE).unlink(missing_ok=True)
        raise PlaceError(f"cannot write into {directory}: {error.strerror}") from error
    return directory


def replay_place(out: Path, log: Path) -> Path:
    """The folder for what is estimated again, made and writable: that of the log's own run, or one
    without a run's results. Raises PlaceError."""
    directory = folder_place("--out", out)
    if not directory.samefile(log.parent):
        others = [name for name in OURS if name != REPORT_FILE]  # an earlier replay leaves one, too
        _refuse_taken(out, others, "take another folder")
    return directory


def _refuse_taken(out: Path, names: Sequence[str], otherwise: str) -> None:
    """Raises PlaceError: a study's results are there, or a run's under one of these names."""
    if (out / STUDY_FILE).exists() or (out / STUDY_CELLS).is_dir():
        raise PlaceError(f"--out {out}: a study's results are there: take another folder")
    if taken := [name for name in names if (out / name).exists()]:
        raise PlaceError(
            f"--out {out}: another run's results are there already ({', '.join(taken)}): "
            f"{otherwise}"
        )


def withdraw(directory: Path) -> None:
    """There are no results after all: the next run may go there."""
    with suppress(OSError):
        for name in OURS:
            (directory / name).unlink(missing_ok=True)
        directory.rmdir()  # if nothing of somebody else's is there


@contextmanager
def withdrawn_unless_begun(directory: Path) -> Iterator[None]:
    """An interrupt before a run's first tick leaves nothing in the way of the next run."""
    try:
        yield
    except KeyboardInterrupt:
        if not _has_rows(directory / TRACE_FILE):
            withdraw(directory)
        raise


def _has_rows(trace: Path) -> bool:
    """Below its line of names."""
    with suppress(OSError), trace.open("rb") as file:
        file.readline()
        return bool(file.readline())
    return False


def fresh(parent: Path, name: str) -> Path:
    """``parent/name``, or with a number behind it where somebody else's results are."""
    there = parent.exists()
    folder_place("the folder", parent)
    number = 1
    while True:
        directory = parent / (name if number == 1 else f"{name}-{number}")
        try:
            directory.mkdir()
        except FileExistsError:
            number += 1
        except OSError as error:
            if not there:
                with suppress(OSError):
                    parent.rmdir()
            raise PlaceError(f"cannot make the folder {directory}: {error.strerror}") from error
        else:
            return directory
