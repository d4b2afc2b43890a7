"""A study's cells, and what is judged of their runs."""

import math
from collections.abc import Sequence
from pathlib import Path
from zipfile import ZipFile

import msgspec
import numpy as np
import pytest

import laglab
from laglab.results.nees import nees
from laglab.scenario import Target, load
from laglab.studies.judged import Judge, Stretch, judgements
from laglab.studies.sweep.cells.cell import Cell
from laglab.studies.sweep.cells.compute import computed
from laglab.studies.sweep.cells.ways import how
from laglab.studies.sweep.loading import load_study, to_toml
from laglab.studies.sweep.study import Study
from laglab.version import _sources
from laglab_control.plugins import source_of

HERE = (0.0, 0.0, 0.0)
SHORT = """
scenario = "lab"
seeds = [3, 5]
grid = { "estimator.kind" = ["delayed-ekf", "raw"], "estimator.initial_covariance" = [0.3] }
[start]
radius = 5.0
"""

LOSSY = """
scenario = { noise = true, duration = 1.5, law = { v_max = 1.0 } }
seeds = 3
[grid]
"link.command.loss" = [0.0, 0.1, 0.4]
"estimator.kind" = ["popf", "delayed-ekf", "ekf"]
"""


@pytest.fixture(scope="module")
def cells(tmp_path_factory: pytest.TempPathFactory) -> list[Cell]:
    path = tmp_path_factory.mktemp("study") / "short.toml"
    path.write_text(SHORT)
    overrides = {"duration": 8.0, "estimator.guard": False}
    return list(load_study(str(path), overrides).cells())


def test_a_row_is_what_the_run_says_of_itself(cells: list[Cell]) -> None:
    for cell in cells:
        for row, seed in zip(computed([cell])[0].to_pylist(), (3, 5), strict=True):
            start = [row[f"start_{axis}"] for axis in ("x", "y", "theta")]
            told = {"duration": 8.0, "estimator.guard": False, "seed": seed, "start": start}
            run = laglab.run("lab", {**told, **cell.grid})
            summary = run.summary
            assert row["seed"] == seed
            assert row["converged"] == summary.converged
            assert (row["settled_s"] is not None) >= summary.converged
            assert row["final_rho"] == pytest.approx(summary.final.rho, abs=1e-9)
            assert row["final_theta_error"] == pytest.approx(summary.final.theta_error, abs=1e-9)
            assert row["max_v"] == pytest.approx(np.abs(run.trace["v"]).max(), abs=1e-9)
            assert (row["diverged_tick"] is not None) == (summary.outcome == "diverged")
            if summary.rms_error is None:
                assert row["rms_x"] is row["nees"] is None
            else:
                assert row["rms_x"] == pytest.approx(summary.rms_error.x, rel=1e-9)
                assert row["rms_theta"] == pytest.approx(summary.rms_error.theta, rel=1e-9)
                assert row["nees"] > 0


def test_cells_on_impaired_links_are_the_same_in_whatever_company(tmp_path: Path) -> None:
    path = tmp_path / "lossy.toml"
    path.write_text(LOSSY)
    cells = list(load_study(str(path)).cells())
    assert all(how(cell).batch for cell in cells)
    together = computed(cells)
    for cell, table in zip(cells, together, strict=True):
        assert table.equals(computed([cell])[0])
    assert not together[0]["rms_x"].equals(together[3]["rms_x"]), "of popf, without loss and with"


def test_where_a_guard_acts_the_row_is_that_of_the_run_alone() -> None:
    told = {"estimator.kind": "ekf", "estimator.guard": True, "duration": 2.0}
    (cell,) = Study(load("lab", told), (1,)).cells()
    run = laglab.run("lab", {**told, "seed": 1})
    assert how(cell).batch
    assert run.alarms
    assert run.summary.rms_error is not None
    (row,) = computed([cell])[0].to_pylist()
    assert row["rms_x"] == pytest.approx(run.summary.rms_error.x, rel=1e-9)
    assert row["final_rho"] == pytest.approx(run.summary.final.rho, abs=1e-9)


def test_a_row_begins_with_what_was_varied_and_has_the_columns_that_others_read(
    cells: list[Cell],
) -> None:
    assert computed([cells[0]])[0].column_names == [
        "estimator.kind", "estimator.initial_covariance", "seed", "start_x", "start_y",
        "start_theta", "converged", "settled_s", "rms_x", "rms_y", "rms_theta", "nees", "final_rho",
        "final_theta_error", "max_v", "max_omega", "diverged_tick",
    ]  # fmt: skip


def test_a_grid_s_table_and_a_key_within_it_go_together_in_whatever_order() -> None:
    grid = {"link.command": [{"loss": 0.1}], "link.command.duplicate": [0.2]}
    for items in (list(grid.items()), list(grid.items())[::-1]):
        (cell,) = Study(load("lab"), [1], dict(items)).cells()
        command = cell.scenario.link.command
        assert (command.loss, command.duplicate) == (0.1, 0.2)


def test_every_seed_starts_somewhere_of_its_own_within_the_radius(cells: list[Cell]) -> None:
    u = np.random.default_rng((5, 3)).random(3)
    x, y, theta = cells[0].starts()[1]
    assert math.hypot(x, y) == pytest.approx(5.0 * math.sqrt(u[0]))
    assert math.atan2(y, x) == pytest.approx(2 * math.pi * u[1] - math.pi)
    assert theta == pytest.approx(2 * math.pi * u[2] - math.pi)
    assert [run.start for run in cells[0].runs()] == [tuple(start) for start in cells[1].starts()]


def test_a_cell_travels_and_keeps_its_key(cells: list[Cell]) -> None:
    away = msgspec.msgpack.decode(msgspec.msgpack.encode(cells[0]), type=Cell)
    assert away == cells[0]
    assert away.key == cells[0].key
    assert away.scenario == cells[0].scenario


def test_another_description_or_other_code_is_another_key(cells: list[Cell]) -> None:
    changes = {"seeds": (3,), "radius": 4.0, "origin": "other", "grid": {"noise": True}}
    keys = {cells[0].key, cells[1].key}
    keys |= {msgspec.structs.replace(cells[0], **{k: v}).key for k, v in changes.items()}
    assert len(keys) == 6


@pytest.mark.parametrize("seeds", [range(1, 4), range(3), range(5, 10), range(2, 10, 2), (7, 3)])
def test_a_study_is_read_back_with_the_same_cells(seeds: Sequence[int], tmp_path: Path) -> None:
    study = Study(load("lab"), seeds, {"link.command.loss": [0.0, 0.1]})
    (tmp_path / "study.toml").write_text(to_toml(study, study.origin))
    again = load_study(str(tmp_path / "study.toml"))
    assert [each.key for each in again.cells()] == [each.key for each in study.cells()]


@pytest.mark.parametrize("key", ["estimator.kind", "law.kind", "plant.kind"])
def test_what_somebody_brings_is_part_of_the_code(
    key: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(str(tmp_path))
    module = tmp_path / f"brought_{key.replace('.', '_')}.py"
    origins = set()
    for text in ("class It: ...", "class It: ...", "class It:  # it is another now"):
        module.write_text(text)
        origins.add(Study(load("lab", {key: f"{module.stem}:It"}), (1,)).origin)
    assert len(origins) == 2


@pytest.mark.parametrize("key", ["link.replay", "law.path", "plant.fmu"])
def test_a_file_of_the_grid_that_has_changed_makes_other_cells(key: str, tmp_path: Path) -> None:
    path, origins = tmp_path / "a_file", set()
    for text in ("this", "this", "that"):
        path.write_text(text)
        origins.add(Study(load("lab"), (1,), {key: [str(path)]}).origin)
    assert len(origins) == 2


def test_of_an_fmu_its_sources_are_part_of_the_code(tmp_path: Path) -> None:
    told = []
    for binary, source in (("1", "a"), ("2", "a"), ("2", "b")):
        with ZipFile(tmp_path / "Robot3.fmu", "w") as fmu:
            fmu.writestr("binaries/x.so", binary)
            fmu.writestr("sources/robot.c", source)
        told.append(dict(_sources(tmp_path, "laglab_fmu")))
    assert told[0] == told[1] != told[2]


def test_a_package_that_fails_as_it_is_loaded_has_no_source(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(str(tmp_path))
    (tmp_path / "failing_package").mkdir()
    (tmp_path / "failing_package" / "__init__.py").write_text("raise SystemExit(3)")
    assert source_of("laglab.laws", "failing_package.laws:It") is None


def test_nees_is_that_of_the_textbook() -> None:
    rng = np.random.default_rng(1)
    root = rng.normal(size=(5, 7, 3, 3))
    P, e = root @ root.swapaxes(-1, -2), rng.normal(size=(5, 7, 3))
    P[2, 3] -= 2 * np.eye(3) * np.linalg.eigvalsh(P[2, 3])[0]
    e[1, 1, 2] = np.inf
    expected = np.einsum("...i,...ij,...j", e, np.linalg.inv(P), e)
    expected[2, 3] = expected[1, 1] = np.nan
    assert nees(e, P) == pytest.approx(expected, rel=1e-8, nan_ok=True)


ON = np.array([np.nan])
"""It did not diverge."""


def at(*distances: float) -> Stretch:
    """A robot on the x axis, at one tick after the other."""
    truth = np.zeros((1, len(distances), 3))
    truth[0, :, 0] = distances
    applied = np.zeros((1, len(distances), 2))
    return Stretch(truth, None, None, applied)


@pytest.mark.parametrize(
    ("distances", "settled", "converged"),
    [
        ((0.0, 0.0, 0.0, 0.0), 0.0, True),
        ((1.0, 0.0, 0.1, 0.05), 1.5, False),
        ((1.0, 0.05, 0.05, 0.05), 0.5, True),
        ((0.0, 0.0, 0.0, 0.07), np.nan, False),
    ],
)
def test_it_has_settled_when_it_does_not_leave_any_more(
    distances: tuple[float, ...], settled: float, converged: bool
) -> None:
    judged = judgements(at(*distances), ON, Target(HERE, None, 0.5), 0)
    assert judged.settled_s == pytest.approx([settled], nan_ok=True)
    assert judged.converged.tolist() == [converged]


def test_many_robots_at_once_are_judged_as_each_alone() -> None:
    rng = np.random.default_rng(2)
    truth = rng.normal(size=(30, 50, 3)).cumsum(axis=1) / 100
    estimates = truth + rng.normal(size=truth.shape) / 10
    claimed = np.tile([0.01, 0, 0, 0.01, 0, 0.01], (30, 50, 1))
    diverged = np.where(np.arange(30) % 7 == 3, 20.0, np.nan)
    applied = rng.normal(size=(30, 50, 2))
    for each in (truth, estimates, claimed, applied):
        each[~np.isnan(diverged), 21:] = np.nan
    target = Target(HERE, None, 0.02)
    record = Stretch(truth, estimates, claimed, applied)
    together = judgements(record, diverged, target, 5)
    piece_by_piece = Judge(target, 5, 30)
    for first in range(0, 50, 3):
        piece_by_piece.add(Stretch(*(each[:, first : first + 3] for each in record)))
    for pieces, whole in zip(piece_by_piece.judgements(diverged), together, strict=True):
        assert pieces == pytest.approx(whole, rel=1e-12, nan_ok=True)
    for robot in range(30):
        ticks = 21 if diverged[robot] == 20 else 50
        alone = Stretch(*(each[robot : robot + 1, :ticks] for each in record))
        judged = judgements(alone, diverged[robot : robot + 1], target, 5)
        for one, all_ in zip(judged, together, strict=True):
            assert one[0] == pytest.approx(all_[robot], rel=1e-12, nan_ok=True)
