"""Names, numbers and folders that nobody thought of: a run, or a line that says what is wrong."""

import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import laglab
from laglab.command import main
from laglab.errors import LaglabError, StudyError
from laglab.results.figures.shown import broken

SHORT = {"duration": 0.2}
RUN = ("run", "lab", "--duration", "0.2")
NAMELESS = os.fsdecode(b"a\xe9")
"""Not UTF-8: a system may call a file so."""

BIG = """
from laglab_gateway import Reading

class Big:
    def __init__(self, *told): pass
    def read(self): return Reading(*[1e308] * 8)
    def step(self, v, omega): pass
    def place(self, x, y, theta): pass
"""

Capture = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What a run left."""
    folder = tmp_path_factory.mktemp("kept") / "run"
    laglab.run("lab-radio", SHORT, out=folder)
    return folder


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def ended(capsys: Capture, *arguments: str) -> tuple[int, str]:
    """The exit code and what was said on standard error, which is in a line."""
    with pytest.raises(SystemExit) as end:
        main(list(arguments))
    code = end.value.code
    assert isinstance(code, int)
    return code, capsys.readouterr().err


def ran(*command: object) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        list(map(str, command)), capture_output=True, text=True, timeout=60, check=False
    )


def a_line(error: str, *words: str) -> bool:
    return error.count("\n") == 1 and all(word in error for word in words)


def test_the_users_modules_are_not_taken_for_the_librarys(here: Path) -> None:
    """Theirs are looked for in the current directory, but last."""
    for name in ("random", "csv"):
        (here / f"{name}.py").write_text(f"raise RuntimeError('my {name}')")
    command = Path(sys.executable).with_name("laglab")
    done = ran(command, *RUN)
    assert done.stderr.count("\n") <= 1, done.stderr
    assert "results in" in done.stdout


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("link.command.extra_delay.mean", 1e308),
        ("link.measurement.bandwidth", 1e-320),
        ("link.command.reorder_by", 1e308),
        ("law.caution", 1e300),
    ],
)
def test_no_finite_number_is_too_large(key: str, value: float) -> None:
    more = {"link.command.reorder": 1.0, "noise": True}
    assert laglab.run("lab", {**SHORT, **more, key: value}).summary.outcome == "completed"


@pytest.mark.usefixtures("here")
def test_an_error_whose_square_is_no_number_is_told_in_words(capsys: Capture) -> None:
    moved = "plant.event=[{at = 0.1, place = [1e200, 0.0, 0.0]}]"
    with pytest.raises(SystemExit):
        main([*RUN, "--set", moved, "--out", "run"])
    assert re.search("RMS error of delayed-ekf +x beyond 1e.154 m, y 2", capsys.readouterr().out)


@pytest.mark.parametrize(
    "told",
    [
        ("--out", f"x/{NAMELESS}"),
        ("--set", f"name={NAMELESS}", "--out", "x"),
        ("--transport", "inline", "--out", NAMELESS),
    ],
)
@pytest.mark.usefixtures("here")
def test_what_is_not_text_is_told(told: tuple[str, ...], capsys: Capture) -> None:
    code, error = ended(capsys, *RUN, *told)
    assert code == 2
    assert a_line(error, "UTF-8")


@pytest.mark.parametrize("file", ["link.csv", "arrivals.csv"])
def test_a_number_that_no_table_holds_is_told(
    here: Path, kept: Path, file: str, capsys: Capture
) -> None:
    shutil.copytree(kept, here / "run")
    lines = (here / "run" / file).read_text().splitlines()
    direction, _, *rest = lines[1].split(",")
    lines[1] = ",".join([direction, "9" * 20, *rest])
    (here / "run" / file).write_text("\n".join(lines))
    code, error = ended(capsys, "figure", "run", "--out", "a.png")
    assert code == 2
    assert a_line(error, file)


def test_a_row_with_other_columns_is_told(here: Path, kept: Path, capsys: Capture) -> None:
    shutil.copytree(kept, here / "run")
    trace = here / "run" / "trace.csv"
    lines = trace.read_text().splitlines()
    trace.write_text("\n".join([*lines[:5], lines[5].rpartition(",")[0], *lines[6:]]) + "\n")
    code, error = ended(capsys, "figure", "run", "--out", "a.png")
    assert code == 2
    assert a_line(error, "another number of columns")


@pytest.mark.parametrize("file", ["scenario.toml", "trace.csv", "summary.json"])
def test_a_file_that_is_gone_is_named(here: Path, kept: Path, file: str, capsys: Capture) -> None:
    shutil.copytree(kept, here / "run")
    (here / "run" / file).unlink()
    code, error = ended(capsys, "figure", "run", "--out", "a.png")
    assert code == 2
    assert a_line(error, "laglab: run", file)
    assert "Errno" not in error


def test_a_line_breaks_where_nothing_was_claimed() -> None:
    time, rows = broken(np.array([0.0, 1.0, 5.0, 6.0]), np.ones((4, 3)), 2.0)
    assert time.tolist() == [0.0, 1.0, 5.0, 5.0, 6.0]
    assert np.isnan(rows[:, 0]).tolist() == [False, False, True, False, False]


def test_a_run_whose_figure_cannot_be_drawn_has_a_verdict(here: Path, capsys: Capture) -> None:
    (here / "big_plant.py").write_text(BIG)
    longer = ("--duration", "0.5", "--set", "plant.kind=big_plant:Big", "--out", "run")
    code, error = ended(capsys, "run", "lab", *longer)
    assert code == 3
    assert "warning: run cannot be drawn: it has numbers that are too large, in x;" in error
    assert "matplotlib" not in error
    assert "diverged" in laglab.open_run(here / "run").summary.verdict


@pytest.mark.parametrize(
    "told",
    [
        {"seeds": [1.5]},
        {"seeds": [True]},
        {"seeds": [-1]},
        {"seeds": [2**31]},
        {"seeds": range(-3, 3)},
        {"seeds": [1], "scenario": "lab"},
        {"seeds": [1], "grid": {"link.command_delay": np.array([])}},
        {"seeds": 5},
        {"seeds": [1], "grid": {"link.command_delay": 5}},
    ],
)
def test_a_study_that_cannot_be_is_refused_in_python_too(told: Mapping[str, Any]) -> None:
    with pytest.raises(StudyError):
        laglab.Study(**{"scenario": laglab.load("lab"), **told})


def test_a_text_is_no_list_of_its_letters() -> None:
    with pytest.raises(StudyError, match=r"grid: estimator.kind: must be a list of values, not 'p"):
        laglab.Study(laglab.load("lab"), [1], {"estimator.kind": "popf"})


def test_a_grid_with_many_values_is_soon_known() -> None:
    """In half a minute at most, though each is held against all others."""
    started = time.monotonic()
    study = laglab.Study(laglab.load("lab"), [1], {"law.gamma": range(1, 100_001)})
    assert study.runs == 100_000
    assert time.monotonic() - started < 30


def test_numbers_of_numpy_are_numbers() -> None:
    scenario = laglab.load("lab", {"link.command_delay": np.int64(3), "start": np.zeros(3)})
    assert (scenario.link.n, scenario.start) == (3, (0.0, 0.0, 0.0))
    study = laglab.Study(scenario, np.arange(3), {"link.measurement_delay": np.arange(2)})
    assert study.seeds == (0, 1, 2)
    assert study.grid == {"link.measurement_delay": (0, 1)}


@pytest.mark.parametrize(
    "call",
    [
        lambda: laglab.run("lab", SHORT, out="a\0b"),
        lambda: laglab.load("lab", {5: 1}),  # type: ignore[dict-item]
        lambda: laglab.load("lab", ["noise"]),  # type: ignore[arg-type]
        lambda: laglab.run("fig6", SHORT).figure("three"),  # type: ignore[arg-type]
    ],
)
def test_what_is_wrong_in_python_is_an_error_of_ours(call: Callable[[], object]) -> None:
    with pytest.raises(LaglabError):
        call()


def test_a_file_as_windows_editors_write_it_is_read(here: Path) -> None:
    (here / "mine.toml").write_text("noise = true\n", encoding="utf-8-sig")
    assert laglab.load(str(here / "mine.toml")).noise


def test_runs_and_studies_keep_out_of_each_others_folders(
    here: Path, kept: Path, capsys: Capture
) -> None:
    shutil.copytree(kept, here / "run")
    (here / "study.toml").write_text('scenario = "fig6"\n')
    short = ("--set", "duration=0.2")
    assert ended(capsys, "sweep", "study.toml", *short, "--out", "study")[0] == 0
    for command in (("sweep", "study.toml", *short, "--out", "run"), (*RUN, "--out", "study")):
        code, error = ended(capsys, *command)
        assert code == 2
        assert a_line(error, "results are there: take another folder")
    assert not (here / "run" / "cells").exists()


@pytest.mark.skipif(shutil.which("bash") is None, reason="no shell limits the size of files here")
@pytest.mark.parametrize(
    ("room", "command", "code", "said"),
    [
        (0, "new law my-law", 4, "cannot write my-law/pyproject.toml"),
        (0, "animate run --out a.gif", 4, "cannot write a.gif"),
        (60, "run lab --duration 0.2 --out lab", 2, "Robot3.fmu cannot be unpacked into"),
    ],
)
def test_what_finds_no_room_is_named(
    here: Path, kept: Path, room: int, command: str, code: int, said: str
) -> None:
    shutil.copytree(kept, here / "run")
    limited = f"ulimit -f {room}; {sys.executable} -m laglab {command}"
    done = ran("bash", "-c", limited)
    assert done.returncode == code, done.stderr
    assert a_line(done.stderr, said, "File too large")
    assert not {"my-law", "a.gif"} & {path.name for path in here.iterdir()}


@pytest.mark.skipif(os.name != "posix", reason="no folder is deleted under who is in it here")
@pytest.mark.parametrize(
    "command", [f"{' '.join(RUN)} --out $OLDPWD/run", " ".join(RUN), "scenario lab"]
)
def test_a_current_directory_that_is_gone_is_told(here: Path, command: str) -> None:
    (here / "gone").mkdir()
    gone = "cd gone && rmdir ../gone"
    done = ran("sh", "-c", f"{gone} && {sys.executable} -m laglab {command}")
    assert done.returncode == 2
    assert a_line(done.stderr, "laglab: the current directory is gone: go to one that is there")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no full device here")
def test_a_parser_for_which_there_is_no_room_is_told(here: Path) -> None:
    (here / "parser").mkdir()
    (here / "parser" / "laglab.py").symlink_to("/dev/full")
    generate = ("protocol", "generate", "--lang", "Python3", "parser")
    done = ran(sys.executable, "-m", "laglab", *generate)
    assert done.returncode == 4
    assert a_line(done.stderr, "parser/laglab.py: No space left on device")
