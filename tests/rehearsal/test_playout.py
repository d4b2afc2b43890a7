"""Play-out makes a link that jitters one that is only late."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import laglab
from laglab.errors import ScenarioError

Laglab = Callable[..., subprocess.CompletedProcess[str]]
Keys = dict[str, object]

JITTER: Keys = {
    "link.command.extra_delay": {"distribution": "uniform", "mean": 0.02, "spread": 0.02},
    "link.measurement.extra_delay": {"distribution": "uniform", "mean": 0.03, "spread": 0.03},
    "link.measurement.duplicate": 0.1,
}
"""Up to 4 ticks, and up to 6."""
PLAYED_OUT: Keys = {"link.playout.command": 14, "link.playout.measurement": 26}


@pytest.mark.parametrize("scenario", ["fig6", "lab"])
def test_jitter_within_the_bounds_is_not_there_any_more(scenario: str) -> None:
    short: Keys = {"duration": 4.0}
    hidden = laglab.run(scenario, short | JITTER | PLAYED_OUT)
    delayed: Keys = {"link.command_delay": 14, "link.measurement_delay": 26}
    ideal = laglab.run(scenario, short | delayed)
    for column, values in ideal.trace.items():
        np.testing.assert_array_equal(hidden.trace[column], values, err_msg=column)
    assert (hidden.summary.n, hidden.summary.m) == (14, 26)
    station = hidden.summary.station
    assert station is not None
    assert (station.n_seen, station.m_seen, station.late) == (14, 26, 0)


def test_who_comes_later_is_dropped_and_counted() -> None:
    tight: Keys = {"link.playout.command": 12, "link.playout.measurement": 22}
    run = laglab.run("fig6", {"duration": 3.0} | JITTER | tight)
    link, station = run.summary.link, run.summary.station
    assert link is not None
    assert station is not None
    rows = run.link
    late = rows["fate"] == "late"
    for direction, bound, n in (("command", 12, 10), ("measurement", 22, 20)):
        own = (rows["direction"] == direction) & (rows["frame"].astype(int) == 0)  # not recalled
        extra = np.ceil(rows["extra"].astype(float) / 0.01 - 1e-9)
        np.testing.assert_array_equal(late & own, own & (n + extra > bound))
    counted = int(np.sum(late & (rows["direction"] == "command")))
    assert counted > 50
    assert link.command.lost == {"late": counted}
    in_the_run = rows["tick"].astype(int) + 20 + extra <= 300
    assert station.late == int(np.sum(late & (rows["direction"] == "measurement") & in_the_run))
    came = run.arrivals
    followed = (came["direction"] == "command") & (came["refused"] == "no")
    delays = (came["arrived"].astype(int) - came["tick"].astype(int))[followed]
    assert set(delays.tolist()) == {12}
    assert 0 < link.refused["late"] <= counted  # of the last ones some had not come by the end


def test_a_recorded_link_leaves_it_to_another_play_out_what_is_late(tmp_path: Path) -> None:
    tight: Keys = {"link.playout.command": 12, "link.playout.measurement": 22}
    laglab.run("fig6", {"duration": 3.0} | JITTER | tight, out=tmp_path / "tight")
    again: Keys = {"link.replay": str(tmp_path / "tight" / "link.csv"), "duration": 3.0}
    wide = laglab.run("fig6", again | PLAYED_OUT)
    assert wide.summary.link is not None
    assert wide.summary.link.command.lost == {}
    same = laglab.run("fig6", {"duration": 3.0} | JITTER | PLAYED_OUT)
    np.testing.assert_array_equal(wide.trace["x"], same.trace["x"])


@pytest.mark.slow
def test_the_same_bytes_inline_over_udp_and_over_a_serial_pair(
    laglab: Laglab, tmp_path: Path
) -> None:
    options = ("--set", "link.playout={command=12,measurement=24}", "--duration", "3")
    traces = set()
    for transport in ("inline", "udp", "serial"):
        out = tmp_path / transport
        result = laglab("run", "lab-radio", *options, "--transport", transport, "--out", str(out))
        assert result.returncode == 0, result.stderr
        traces.add((out / "trace.csv").read_bytes() + (out / "link.csv").read_bytes())
    assert len(traces) == 1


def test_a_shadow_hears_what_the_station_heard() -> None:
    options: Keys = {"duration": 3.0, "estimator.compare": ["delayed-ekf"], "noise": True}
    run = laglab.run("fig6", options | JITTER | PLAYED_OUT | {"estimator.kind": "delayed-ekf"})
    assert run.summary.compare["delayed-ekf"] == run.summary.rms_error


@pytest.mark.parametrize("direction", ["command", "measurement"])
def test_a_bound_below_the_links_own_delay_is_refused(direction: str) -> None:
    with pytest.raises(ScenarioError, match=rf"playout\.{direction}: must be \d0 or more"):
        laglab.load("fig6", {f"link.playout.{direction}": 5})


@pytest.mark.slow
def test_in_real_time_too() -> None:
    options: Keys = {"duration": 3.0, "pace": "realtime", "speed": 2.0}
    run = laglab.run("fig6", options | JITTER | PLAYED_OUT)
    came = run.arrivals
    followed = (came["direction"] == "command") & (came["refused"] == "no")
    delays = came["arrived"].astype(int) - came["tick"].astype(int)
    assert set(delays[followed].tolist()) == {14}
