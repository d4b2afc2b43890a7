"""Where a run's results go; all that can be wrong with it is found before anything runs."""

import tempfile
from pathlib import Path

from laglab.errors import PlaceError
from laglab.results.run import SCENARIO_FILE
from laglab.results.summary import SUMMARY_FILE
from laglab.scenario import Scenario
from laglab_gateway import LINK_FILE, TIMING_FILE, TLOG_FILE, TRACE_FILE

OURS = (SCENARIO_FILE, SUMMARY_FILE, TRACE_FILE, TLOG_FILE, LINK_FILE, TIMING_FILE)


def place(scenario: Scenario, out: Path | None, force: bool = False, suffix: str = "") -> Path:
    """The folder for the run's results, made and writable, the scenario already in it.

    Without `out` a new one, `runs/SCENARIO` or with a number behind it; an explicit one that holds
    another run's results is taken only with `force`. Raises PlaceError.
    """
    if out is None:
        directory = _fresh(Path("runs"), scenario.name + suffix)
    else:
        directory = made(out)
        if not force and (taken := [name for name in OURS if (directory / name).exists()]):
            raise PlaceError(
                f"--out {out}: another run's results are there already ({', '.join(taken)}): take "
                "another folder, or say --force"
            )
    _check_writable(directory)
    for name in OURS:
        (directory / name).unlink(missing_ok=True)
    text = scenario.to_toml(directory)
    try:
        (directory / SCENARIO_FILE).write_text(text, encoding="utf-8")
    except OSError as error:
        raise PlaceError(f"cannot write into {directory}: {error.strerror}") from error
    return directory


def _fresh(parent: Path, name: str) -> Path:
    """``parent/name``, or with a number behind it where somebody else's results are."""
    number = 1
    while True:
        directory = parent / (name if number == 1 else f"{name}-{number}")
        try:
            directory.mkdir(parents=True)
        except FileExistsError:
            number += 1
            if parent.exists() and not parent.is_dir():
                raise PlaceError(f"{parent} is a file: results go into a folder") from None
        except OSError as error:
            raise PlaceError(f"cannot make the folder {directory}: {error.strerror}") from error
        else:
            return directory


def made(directory: Path) -> Path:
    """The folder that `--out` names, made where it is not there. Raises PlaceError."""
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        raise PlaceError(f"--out {directory}: that is a file: results go into a folder") from None
    except OSError as error:
        raise PlaceError(f"--out {directory}: cannot make the folder: {error.strerror}") from error
    return directory


def _check_writable(directory: Path) -> None:
    try:
        tempfile.TemporaryFile(dir=directory).close()
    except OSError as error:
        raise PlaceError(f"cannot write into {directory}: {error.strerror}") from error
