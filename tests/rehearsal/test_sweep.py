"""Studies, computed by processes of our own: interrupted, killed, resumed, changed."""

import os
import random
import re
import signal
import subprocess
import sys
import time
import tomllib
import tracemalloc
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

import laglab as lab
from laglab.errors import StudyError
from laglab.studies.sweep.cells.tasks import grouped
from laglab.studies.sweep.folder import ABANDONED, Folder
from laglab.studies.sweep.loading import load_study, shipped_study_names
from laglab.studies.sweep.work import work_left
from laglab.studies.workers import as_done

from .studying import (
    CELLS,
    SEEDS,
    SHORT,
    SMALL,
    Contents,
    contents,
    nothing_again,
    undisturbed,
    wait_for_cells,
)

pytestmark = pytest.mark.timeout(180)
Laglab = Callable[..., subprocess.CompletedProcess[str]]
Start = Callable[..., "subprocess.Popen[str]"]
SWEEP = ("sweep", "small.toml", *SHORT, "--out", "out")


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> Contents:
    path = tmp_path_factory.mktemp("expected") / "small.toml"
    path.write_text(SMALL)
    return undisturbed(path)


@pytest.fixture
def out(tmp_path: Path) -> Path:
    (tmp_path / "small.toml").write_text(SMALL)
    return tmp_path / "out"


def workers_of(process: "subprocess.Popen[str]") -> list[int]:
    """Its children."""
    listed = Path(f"/proc/{process.pid}/task").glob("*/children")
    return [int(number) for path in listed for number in path.read_text().split()]


def gone(number: int) -> bool:
    """Whether that process is."""
    deadline = time.monotonic() + 10
    while time.monotonic() < deadline:
        try:
            if ") Z " in Path(f"/proc/{number}/stat").read_text():
                return True
        except OSError:
            return True
        time.sleep(0.05)
    return False


def test_a_killed_worker_loses_nothing(start: Start, out: Path, expected: Contents) -> None:
    sweep = start(*SWEEP, "--workers", "2")
    rng = random.Random(1)
    for count in (1, 3):
        wait_for_cells(out, count)
        time.sleep(rng.uniform(0.0, 0.1))
        os.kill(rng.choice(workers_of(sweep)), signal.SIGKILL)
    output, errors = sweep.communicate(timeout=50)
    assert sweep.returncode == 0, errors
    assert not errors
    assert f"{CELLS * SEEDS} runs" in output
    assert contents(out) == expected


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGKILL, -9)])
def test_what_was_done_is_kept_and_the_rest_is_done_later(
    start: Start, laglab: Laglab, out: Path, expected: Contents, number: int, code: int
) -> None:
    sweep = start(*SWEEP, "--workers", "2")
    wait_for_cells(out, 2)
    time.sleep(random.Random(number).uniform(0.0, 0.2))
    workers = workers_of(sweep)
    sweep.send_signal(number)
    _, errors = sweep.communicate(timeout=20)
    assert sweep.returncode == code
    if code == 130:
        kept, ended = errors.splitlines()
        assert re.fullmatch(r"\d+ of \d+ runs are kept: .*goes on from there", kept)
        assert ended == "laglab: interrupted"
    else:
        assert not errors
    assert len(workers) == 2
    assert all(map(gone, workers))
    for half in (out / "cells").glob(".*.new"):  # killed while it was being written
        assert number == signal.SIGKILL
        half.unlink()
    before = contents(out)
    assert 2 <= len(before) < CELLS
    with nothing_again(out):
        again = laglab(*SWEEP)
    assert again.returncode == 0, again.stderr
    assert f"{SEEDS * len(before)} of them had been made before" in again.stdout
    assert contents(out) == expected


def test_two_at_once_do_no_harm(start: Start, out: Path, expected: Contents) -> None:
    both = [start(*SWEEP, "--workers", "1") for _ in range(2)]
    for sweep in both:
        _, errors = sweep.communicate(timeout=50)
        assert sweep.returncode == 0, errors
        assert not errors
    assert contents(out) == expected


def test_a_study_that_was_changed_says_what_is_no_longer_part_of_it(
    laglab: Laglab, out: Path, expected: Contents
) -> None:
    (out / "cells").mkdir(parents=True)
    for name, content in expected.items():
        (out / "cells" / name).write_bytes(content)
    (out.parent / "small.toml").write_text(SMALL.replace(", 14]", "]"))
    with nothing_again(out):
        changed = laglab(*SWEEP)
    assert changed.returncode == 0
    assert f"{14 * SEEDS} of them had been made before" in changed.stdout
    assert "2 cells are no longer part of the study" in changed.stderr
    assert "link.command_delay = 14, estimator.kind = popf" in changed.stderr
    assert len(contents(out)) == CELLS
    assert lab.open_study(out).table.num_rows == 14 * SEEDS


def test_other_code_computes_anew(out: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    study = load_study(str(out.parent / "small.toml"))
    keys = {cell.key for cell in study.cells()}
    monkeypatch.setattr("laglab.studies.sweep.study.code_version", lambda: "another")
    other = load_study(str(out.parent / "small.toml"))
    assert not keys & {cell.key for cell in other.cells()}


def test_what_another_is_writing_stays_and_what_nobody_will_finish_goes(out: Path) -> None:
    study = load_study(str(out.parent / "small.toml"))
    cells = Folder.made(out, study).cells
    for name, age in ((".1-a.new", 60.0), (".2-b.new", ABANDONED + 60)):
        (cells / name).touch()
        os.utime(cells / name, (time.time() - age,) * 2)
    Folder.made(out, study)
    assert [path.name for path in cells.iterdir()] == [".1-a.new"]


def test_from_python_with_any_executor(tmp_path: Path) -> None:
    path = tmp_path / "small.toml"
    path.write_text(SMALL.replace("0, 2, 4, 6, 8, 10, 12, 14", "0, 10"))
    study = load_study(str(path), {"duration": 1.0})
    with ThreadPoolExecutor(1) as threads:
        result = lab.sweep(study, executor=threads)
    frame = result.to_pandas()
    assert len(frame) == study.runs == 12
    assert list(frame["seed"][:4]) == [1, 2, 3, 1]
    assert list(frame["estimator.kind"][2:4]) == ["popf", "delayed-ekf"]
    there = result.map("link.command_delay", "estimator.kind", "rms_x")
    assert there.shape == (2, 2)
    some = frame[(frame["link.command_delay"] == 10) & (frame["estimator.kind"] == "popf")]
    assert there.loc["popf", 10] == pytest.approx(some["rms_x"].mean())
    assert result.map("estimator.kind", "seed", "converged").to_numpy().max() == 0.0
    with pytest.raises(StudyError, match="no column 'nonsense'"):
        result.map("nonsense", "seed", "rms_x")


TABLES = """
scenario = "lab"
[grid]
duration = [0.3]
"link.command" = [{ loss = 0.3 }]
"link.command.extra_delay.mean" = [0.0, 0.03]
"plant.event" = [[{ at = 0.1, by = [0.1, 0, 0] }, { at = 0.2, by = [0.1, 0, 0] }], []]
"""


def test_tables_in_a_grid_stay_what_they_are(tmp_path: Path) -> None:
    (tmp_path / "tables.toml").write_text(TABLES)
    out = tmp_path / "out"
    study = load_study(str(tmp_path / "tables.toml"))
    with ThreadPoolExecutor(1) as threads:
        frame = lab.sweep(study, out=out, executor=threads).to_pandas()
    assert set(frame["link.command"]) == {"{loss = 0.3}"}
    events = {str(tomllib.loads(f"event = {text}")["event"]) for text in frame["plant.event"]}
    assert events == {"[{'at': 0.1, 'by': [0.1, 0, 0]}, {'at': 0.2, 'by': [0.1, 0, 0]}]", "[]"}
    again = load_study(str(tmp_path / "tables.toml"))
    assert not work_left(again, folder=Folder.made(out, again)).runs


def test_from_a_plain_script_processes_of_our_own(tmp_path: Path) -> None:
    """Which has no guard for what happens when it is imported."""
    (tmp_path / "small.toml").write_text(SMALL.replace("0, 2, 4, 6, 8, 10, 12, 14", "0, 10"))
    script = (
        "import laglab",
        "print('once')",
        "study = laglab.load_study('small.toml', {'duration': 0.5})",
        "print(laglab.sweep(study).table.num_rows)",
    )
    (tmp_path / "script.py").write_text("\n".join(script))
    ran = subprocess.run(
        [sys.executable, "script.py"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert ran.stdout == "once\n12\n", ran.stderr


def test_a_folder_is_read_whatever_the_code_is_by_now(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "tiny.toml"
    path.write_text('scenario = "fig6"\n[grid]\nnoise = [false, true]\n')
    study = load_study(str(path), {"duration": 0.5})
    with ThreadPoolExecutor(1) as threads:
        lab.sweep(study, executor=threads, out=tmp_path / "out")
    monkeypatch.setattr("laglab.studies.sweep.study.code_version", lambda: "another")
    again = lab.open_study(tmp_path / "out")
    assert again.table.num_rows == 2
    assert again.missing == 0
    assert dict(again.study.grid) == {"noise": (False, True)}


class AtOnce:
    """Does a job when it is told to."""

    def submit(self, function: Callable[[Any], Any], job: Any, /) -> "Future[Any]":
        future: Future[Any] = Future()
        future.set_result(function(job))
        return future


def memory_of(seeds: int) -> int:
    """The most that planning and handing out take [bytes], and no less than there are cells."""
    study = load_study("gains", {"duration": 1.0}, seeds)
    cells = sum(1 for _ in study.cells())
    tracemalloc.start()
    try:
        work_left(study)
        tasks = as_done(AtOnce(), id, grouped(study.cells()), ahead=100)
        assert sum(len(task.cells) for task, _ in tasks) == cells
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_memory_does_not_grow_with_the_study() -> None:
    memory_of(250)  # what is loaded and cached only once
    assert memory_of(1500) < 1.2 * memory_of(500)


@pytest.mark.parametrize("name", shipped_study_names())
def test_every_shipped_study_can_be_run(name: str) -> None:
    study = load_study(name)
    assert study.description
    assert work_left(study).runs == study.runs < 20_000


def test_without_a_study_they_are_listed(ended: Callable[..., Any]) -> None:
    listed = ended("sweep")
    assert listed.code == 0
    assert all(name in listed.out for name in shipped_study_names())
