"""``laglab replay``: estimating again from the log of a session."""

import csv
import shutil

import numpy as np
import pytest

import laglab
from laglab.results.columns import joined
from laglab.results.replaying import draw_replays, replayed_run, replays_table
from laglab.results.shadows import COLUMNS, shadow_pieces
from laglab.scenario import load
from laglab_gateway import read_trace
from laglab_protocol import Measurement, Sender, Tick, read_tlog, tlog_record


@pytest.fixture
def replay(ended):
    return lambda *arguments: ended("replay", *arguments).code


def estimates(path):
    with path.open() as file:
        rows = list(csv.DictReader(file))
    return np.array([[float(row[axis]) for axis in ("x", "y", "theta")] for row in rows])


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A folder with what a short noisy run left."""
    folder = tmp_path_factory.mktemp("short") / "run"
    laglab.run("lab", {"duration": 2.0, "estimator.kind": "delayed-ekf"}, out=folder)
    return folder


@pytest.fixture
def stations_estimates(run):
    trace = read_trace(run / "trace.csv")
    return np.stack([trace["x_est"], trace["y_est"], trace["theta_est"]], axis=1)


def test_the_filter_of_the_run_says_the_same_again(replay, run, stations_estimates, tmp_path):
    out = tmp_path / "again"
    assert replay(run / "robot.tlog", "--estimator", "delayed-ekf", "--out", out) == 0
    np.testing.assert_array_equal(estimates(out / "delayed-ekf.csv"), stations_estimates)


def test_several_filters_in_one_table_and_one_picture(ended, run, tmp_path):
    out = tmp_path / "several"
    names = ["popf", "ekf", "raw"]
    options = [part for name in names for part in ("--estimator", name)]
    code, table, _ = ended("replay", run / "robot.tlog", *options, "--out", out)
    assert code == 0
    assert "RMS deviation" in table
    assert all(name in table for name in names)
    assert (out / "replay.png").read_bytes().startswith(b"\x89PNG")
    assert np.abs(estimates(out / "popf.csv") - estimates(out / "ekf.csv")).max() > 0.01


def test_without_true_poses_nothing_is_called_true(run):
    trace = read_trace(run / "trace.csv")
    real = trace | {axis: np.full(len(trace["tick"]), np.nan) for axis in ("x", "y", "theta")}
    replays = {"raw": {name: np.arange(3.0) for name in COLUMNS}}
    for told, wanted in ((trace, ["true", "raw"]), (real, ["raw"])):
        figure = draw_replays(load("lab"), [], replays, told)
        above, below = figure.axes[0], figure.axes[3]
        drawn = [line.get_label() for line in above.lines]
        assert [label for label in drawn if label in ("true", "raw")] == wanted
        assert ("measured" in below.get_ylabel()) == (told is real)
        assert [text.get_text() for text in below.get_legend().get_texts()] == ["±2σ claimed"]
        assert ("from measured" in replays_table(replays, told).columns[-1].header) == (
            told is real
        )


def test_a_log_alone_is_enough_with_a_scenario_for_model_and_prior(ended, run, tmp_path):
    """As from a real robot: no trace, no true poses."""
    log = tmp_path / "session.tlog"
    log.write_bytes((run / "robot.tlog").read_bytes())
    out = tmp_path / "alone"
    options = ("--estimator", "popf", "--scenario", "lab", "--p0", "0.01", "--out", out)
    code, said, _ = ended("replay", log, *options)
    assert code == 0
    assert "popf" in said
    assert "RMS" not in said
    assert len(estimates(out / "popf.csv")) == 201


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["missing.tlog", "--estimator", "popf", "--scenario", "lab"], "missing.tlog"),
        (["{log}", "--estimator", "best"], "estimator.kind: must be one of raw, ekf"),
        (["{empty}", "--estimator", "popf", "--scenario", "lab"], "no tick of a robot in it"),
    ],
)
def test_what_cannot_be_replayed_is_said_in_one_line(refused, run, tmp_path, arguments, said):
    empty = tmp_path / "empty.tlog"
    empty.write_bytes(b"")
    places = {"log": run / "robot.tlog", "empty": empty}
    assert said in refused("replay", *(argument.format(**places) for argument in arguments))


def test_frames_of_other_systems_change_nothing(replay, run, stations_estimates, tmp_path):
    stranger, log = Sender(7, 1), shutil.copytree(run, tmp_path / "heard") / "robot.tlog"
    records = [
        tlog_record(time, frame.raw)
        + tlog_record(time, stranger.frame(Measurement(9.0, 9.0, 9.0, 0.0, 0.0, 10**6, -1)))
        + tlog_record(time, stranger.frame(Tick(10**6, 1)))
        for time, frame in read_tlog(log)
    ]
    log.write_bytes(b"".join(records))
    out = tmp_path / "again"
    assert replay(log, "--estimator", "delayed-ekf", "--out", out) == 0
    np.testing.assert_array_equal(estimates(out / "delayed-ekf.csv"), stations_estimates)


def test_a_tick_beyond_the_run_is_none_of_it(replay, run, stations_estimates, tmp_path):
    robot, log = Sender(1, 1), shutil.copytree(run, tmp_path / "longer") / "robot.tlog"
    with log.open("ab") as file:
        file.write(tlog_record(0, robot.frame(Tick(5000, 0))))
    out = tmp_path / "beyond"
    assert replay(log, "--estimator", "delayed-ekf", "--out", out) == 0
    assert np.array_equal(estimates(out / "delayed-ekf.csv")[:201], stations_estimates)


def test_the_page_of_a_replay_has_the_numbers_of_what_was_replayed(replay, run, tmp_path):
    assert replay(run / "robot.tlog", "--estimator", "ekf", "--out", tmp_path / "out") == 0
    replayed = joined(shadow_pieces(tmp_path / "out" / "ekf.csv"))
    summary = replayed_run(run, {"ekf": replayed}).summary
    assert summary.compare.keys() == {"delayed-ekf", "ekf"}
    assert summary.compare["delayed-ekf"] == summary.rms_error
    x = read_trace(run / "trace.csv")["x"]
    error = estimates(tmp_path / "out" / "ekf.csv")[20:, 0] - x[20:]
    assert summary.compare["ekf"].x == pytest.approx(np.sqrt(np.mean(error**2)), rel=1e-9)


def test_of_a_run_that_was_killed_the_log_is_named(run, tmp_path, refused):
    killed = shutil.copytree(run, tmp_path / "killed")
    (killed / "summary.json").unlink()
    line = refused("figure", killed, "--out", "x.png")
    said = f"can be replayed: laglab replay {killed / 'robot.tlog'} --estimator NAME"
    assert said in line


def test_a_page_of_a_run_that_was_killed_is_refused_before_it_is_replayed(run, tmp_path, refused):
    killed, out = shutil.copytree(run, tmp_path / "killed"), tmp_path / "out"
    (killed / "summary.json").unlink()
    assert "was killed" in refused("replay", killed, "--estimator", "ekf", "--report", "--out", out)
    assert not out.exists()


@pytest.mark.slow
def test_a_replay_is_not_mixed_with_another_runs_results(replay, refused, run, tmp_path):
    ekf = ("--estimator", "ekf", "--report", "--out")
    other = shutil.copytree(run, tmp_path / "other")
    before = {each.name for each in other.iterdir()}
    line = refused("replay", run / "robot.tlog", *ekf, other)
    assert f"--out {other}: another run's results are there already (scenario.toml, " in line
    assert {each.name for each in other.iterdir()} == before
    assert replay(other / "robot.tlog", *ekf, other) == 0, "the log's own run"
    for _ in range(2):
        assert replay(run / "robot.tlog", *ekf, tmp_path / "again") == 0, "an earlier replay"
    (tmp_path / "study").mkdir()
    (tmp_path / "study" / "study.toml").touch()
    assert "a study's results" in refused("replay", run / "robot.tlog", *ekf, tmp_path / "study")
