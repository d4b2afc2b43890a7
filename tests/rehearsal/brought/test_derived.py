"""Filters built on Backdated: what is told is whose line it was, and what they must answer."""

from pathlib import Path

import pytest

from laglab.runs import rehearse
from laglab.scenario import load
from laglab_gateway import MemoryRecorder

TOLD = "# the line that is told"
ANSWERS = {
    "ListOfX": "correct: corrected must answer x as an array (d,), not [",
    "Column": "correct: corrected must answer x as an array (d,), not array([[",
    "Variances": "correct: corrected must answer P as an array (3, 3), not array([",
    "Nothing": "correct: corrected must answer x (d,) and P (d, d), not None",
    "ListForward": "predict: forward must answer x as an array (d,), not [",
}


def problem_of(name: str) -> str:
    """Of a run with that filter."""
    told = {"estimator.kind": f"derived:{name}", "estimator.guard": False, "duration": 1.0}
    ending = rehearse.rehearse_inline(load("lab", told), MemoryRecorder())
    assert ending.exit_code == 4
    return ending.problem


def line_in(path: Path, name: str) -> int:
    """Of the class of that name, the one that is marked."""
    lines = path.read_text().splitlines()
    begin = lines.index(f"class {name}(Derived):")
    return next(i for i, line in enumerate(lines[begin:], begin + 1) if line.endswith(TOLD))


@pytest.mark.parametrize("name", ["Raising", "InNumpy", "InOurs", "InLibrary", "InNoFile"])
def test_the_line_told_is_of_the_file_that_was_brought(brought: Path, name: str) -> None:
    problem = problem_of(name)
    assert problem.startswith(f"tick 30: derived:{name}.correct: ")
    assert problem.endswith(f" (derived.py, line {line_in(brought / 'derived.py', name)})")


@pytest.mark.usefixtures("brought")
def test_of_several_files_it_is_the_one_that_raised_it() -> None:
    assert "something is wrong (mine.py, line" in problem_of("InAnother")


@pytest.mark.usefixtures("brought")
@pytest.mark.parametrize("name", ANSWERS)
def test_what_must_be_answered_is_said_in_words(name: str) -> None:
    tick = 1 if name == "ListForward" else 30
    assert problem_of(name).startswith(f"tick {tick}: derived:{name}.{ANSWERS[name]}")
