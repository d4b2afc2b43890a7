"""Several filters in one run: the first in the loop, the others on the same record."""

import numpy as np
import pytest

from laglab.results.shadows import beside


def test_the_first_drives_and_all_are_compared(rehearsed, tmp_path, capsys):
    names = ["delayed-ekf", "popf", "ekf"]
    options = [part for name in names for part in ("--estimator", name)]
    unguarded = ("--set", "estimator.guard=false")
    summary = rehearsed("lab", "--duration", "3", *unguarded, *options)
    assert summary["estimator"] == "delayed-ekf"
    errors = summary["compare"]
    assert list(errors) == names
    assert errors["delayed-ekf"] == summary["rms_error"]
    assert errors["ekf"]["x"] > 3 * errors["popf"]["x"]
    table = capsys.readouterr().out
    assert all(f"RMS error of {name}" in table for name in names)
    assert (tmp_path / "run" / "figure.png").exists()


def test_a_shadow_hears_what_the_station_heard(rehearsed):
    """The filter of the loop, named again, says the same: n and m as in the link, not assumed."""
    options = ["--estimator", "popf", "--estimator", "popf-exact", "--estimator", "delayed-ekf"]
    once = rehearsed("lab", "--duration", "1", *options)
    other = rehearsed("lab", "--duration", "1", "--estimator", "popf")
    assert once["compare"]["popf"] == other["rms_error"]


@pytest.mark.parametrize("transport", ["inline", "udp"])
def test_the_station_reports_delays_speed_and_warnings(laglab, tmp_path, transport):
    import json

    out = tmp_path / transport
    ended = laglab(
        "run", "fig6", "--p0", "1e-3", "--duration", "1", "--transport", transport,
        "--out", str(out),
    )  # fmt: skip
    station = json.loads((out / "summary.json").read_text())["station"]
    assert (station["n_seen"], station["m_seen"]) == (10, 20)
    assert 0 < station["tick_p50_s"] <= station["tick_p99_s"] <= station["tick_longest_s"] < 1
    (warning,) = station["warnings"]
    assert warning.startswith("tick 20: popf's gain is 0.")
    assert " ".join(ended.stderr.split()).count(warning) == 1
    assert "p99" in ended.stdout


def test_what_was_said_of_ticks_that_the_trace_lacks_is_left_out() -> None:
    said = {"tick": np.arange(4.0), **dict.fromkeys(("x", "y", "theta"), np.arange(4.0))}
    columns = beside({"tick": np.array([0.0, 2.0])}, said, "ekf")
    assert columns["x_ekf"].tolist() == [0.0, 2.0]
