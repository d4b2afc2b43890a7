"""Several filters in one run: the first in the loop, the others on the same record."""

import json

import numpy as np
import pytest

import laglab
from laglab.results.shadows import shadowing


def test_the_first_drives_and_all_are_compared(ended, tmp_path):
    names = ["delayed-ekf", "popf", "ekf"]
    options = [part for name in names for part in ("--estimator", name)]
    unguarded = ("--set", "estimator.guard=false")
    inline = ("--transport", "inline", "--out", tmp_path / "run")
    table = ended("run", "lab", "--duration", "3", *unguarded, *options, *inline).out
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert summary["estimator"] == "delayed-ekf"
    errors = summary["compare"]
    assert list(errors) == names
    assert errors["delayed-ekf"] == summary["rms_error"]
    assert errors["ekf"]["x"] > 3 * errors["popf"]["x"]
    assert all(f"RMS error of {name}" in table for name in names)
    assert (tmp_path / "run" / "figure.png").exists()


def test_a_shadow_hears_what_the_station_heard(rehearsed):
    """The filter of the loop, named again, says the same: n and m as in the link, not assumed."""
    options = ["--estimator", "popf", "--estimator", "popf-exact", "--estimator", "delayed-ekf"]
    once = rehearsed("lab", "--duration", "1", *options)
    other = rehearsed("lab", "--duration", "1", "--estimator", "popf")
    assert once["compare"]["popf"] == other["rms_error"]


@pytest.mark.parametrize("transport", ["inline", "udp"])
def test_the_station_reports_delays_speed_and_warnings(ended, tmp_path, transport):
    out = tmp_path / transport
    options = ("--p0", "1e-3", "--duration", "1", "--transport", transport, "--out", out)
    done = ended("run", "fig6", *options)
    station = json.loads((out / "summary.json").read_text())["station"]
    assert (station["n_seen"], station["m_seen"]) == (10, 20)
    assert 0 < station["tick_p50_s"] <= station["tick_p99_s"] <= station["tick_longest_s"] < 1
    (warning,) = station["warnings"]
    assert warning.startswith("tick 20: popf's gain is 0.")
    assert " ".join(done.err.split()).count(warning) == 1
    assert "p99" in done.out


def test_what_was_said_of_ticks_that_the_trace_lacks_is_left_out() -> None:
    said = {"tick": np.arange(4.0), **dict.fromkeys(("x", "y", "theta"), np.arange(4.0))}
    columns = shadowing({"tick": np.array([0.0, 2.0])}, said, "ekf")
    assert columns["x_ekf"].tolist() == [0.0, 2.0]


def test_one_that_diverges_ends_early_and_quietly():
    """Its matrices overflow in the prediction, too; a warning of numpy's is an error here."""
    diverging = {"estimator.kind": "raw", "link.measurement_delay": 27, "duration": 30.0}
    done = laglab.run("fig6", diverging | {"estimator.compare": ["popf"]})
    shadow = done.trace["x_popf"]
    assert np.abs(shadow[np.isfinite(shadow)]).max() > 1e6


def test_of_a_long_run_it_is_said_what_takes_so_long(ended, tmp_path, monkeypatch):
    monkeypatch.setattr("laglab.commands.runs.verdict.LONG", 50)
    beside = ("--estimator", "delayed-ekf", "--estimator", "ekf", "--transport", "inline")
    for seconds, said in (("0.5", ""), ("0.6", "what ekf would have said, of 60 ticks ...")):
        code, _, stderr = ended(
            "run", "lab", "--duration", seconds, *beside, "--out", tmp_path / seconds
        )
        assert (code, stderr.strip()) == (0, said)
