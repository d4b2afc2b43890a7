"""``laglab replay``: estimating again from the log of a session."""

import csv

import numpy as np
import pytest

from laglab.command import main
from laglab.results.replaying import replayed_run
from laglab.results.shadows import read_shadow
from laglab_gateway import read_trace
from laglab_protocol import Measurement, Sender, Tick, read_tlog, tlog_record


def replay(*arguments):
    with pytest.raises(SystemExit) as ended:
        main(["replay", *map(str, arguments)])
    return ended.value.code


def estimates(path):
    with path.open() as file:
        rows = list(csv.DictReader(file))
    return np.array([[float(row[axis]) for axis in ("x", "y", "theta")] for row in rows])


@pytest.fixture
def run(rehearsed, tmp_path):
    """A folder with what a short noisy run left."""
    rehearsed("lab", "--duration", "2", "--estimator", "delayed-ekf")
    return tmp_path / "run"


@pytest.fixture
def stations_estimates(run):
    trace = read_trace(run / "trace.csv")
    return np.stack([trace["x_est"], trace["y_est"], trace["theta_est"]], axis=1)


def test_the_filter_of_the_run_says_the_same_again(run, stations_estimates, tmp_path):
    out = tmp_path / "again"
    assert replay(run / "robot.tlog", "--estimator", "delayed-ekf", "--out", out) == 0
    np.testing.assert_array_equal(estimates(out / "delayed-ekf.csv"), stations_estimates)


def test_several_filters_in_one_table_and_one_picture(run, tmp_path, capsys):
    out = tmp_path / "several"
    names = ["popf", "ekf", "raw"]
    options = [part for name in names for part in ("--estimator", name)]
    assert replay(run / "robot.tlog", *options, "--out", out) == 0
    table = capsys.readouterr().out
    assert "RMS deviation" in table
    assert all(name in table for name in names)
    assert (out / "replay.png").read_bytes().startswith(b"\x89PNG")
    assert np.abs(estimates(out / "popf.csv") - estimates(out / "ekf.csv")).max() > 0.01


def test_a_log_alone_is_enough_with_a_scenario_for_model_and_prior(run, tmp_path, capsys):
    """As from a real robot: no trace, no true poses."""
    log = tmp_path / "session.tlog"
    log.write_bytes((run / "robot.tlog").read_bytes())
    out = tmp_path / "alone"
    code = replay(log, "--estimator", "popf", "--scenario", "lab", "--p0", "0.01", "--out", out)
    assert code == 0
    assert "RMS" not in capsys.readouterr().out
    assert len(estimates(out / "popf.csv")) == 201


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["missing.tlog", "--estimator", "popf", "--scenario", "lab"], "missing.tlog"),
        (["{log}", "--estimator", "best"], "estimator.kind: must be one of raw, ekf"),
        (["{empty}", "--estimator", "popf", "--scenario", "lab"], "no tick of a robot in it"),
    ],
)
def test_what_cannot_be_replayed_is_said_in_one_line(run, tmp_path, capsys, arguments, said):
    empty = tmp_path / "empty.tlog"
    empty.write_bytes(b"")
    places = {"log": run / "robot.tlog", "empty": empty}
    assert replay(*(argument.format(**places) for argument in arguments)) == 2
    assert said in capsys.readouterr().err


def test_frames_of_other_systems_change_nothing(run, stations_estimates, tmp_path):
    stranger, log = Sender(7, 1), run / "robot.tlog"
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


def test_a_tick_beyond_the_run_is_none_of_it(run, stations_estimates, tmp_path):
    robot, log = Sender(1, 1), run / "robot.tlog"
    with log.open("ab") as file:
        file.write(tlog_record(0, robot.frame(Tick(5000, 0))))
    out = tmp_path / "beyond"
    assert replay(log, "--estimator", "delayed-ekf", "--out", out) == 0
    assert np.array_equal(estimates(out / "delayed-ekf.csv")[:201], stations_estimates)


def test_the_page_of_a_replay_has_the_numbers_of_what_was_replayed(run, tmp_path):
    assert replay(run / "robot.tlog", "--estimator", "ekf", "--out", tmp_path / "out") == 0
    summary = replayed_run(run, {"ekf": read_shadow(tmp_path / "out" / "ekf.csv")}).summary
    assert summary.compare.keys() == {"delayed-ekf", "ekf"}
    assert summary.compare["delayed-ekf"] == summary.rms_error
    x = read_trace(run / "trace.csv")["x"]
    error = estimates(tmp_path / "out" / "ekf.csv")[20:, 0] - x[20:]
    assert summary.compare["ekf"].x == pytest.approx(np.sqrt(np.mean(error**2)), rel=1e-9)


def test_of_a_run_that_was_killed_the_log_is_named(run, capsys):
    (run / "summary.json").unlink()
    with pytest.raises(SystemExit) as ended:
        main(["figure", str(run), "--out", "x.png"])
    assert ended.value.code == 2
    assert f"can be replayed: laglab replay {run / 'robot.tlog'}" in capsys.readouterr().err
