"""What a run records besides its trace: when everything came, and what the station claimed."""

from pathlib import Path

import numpy as np
import pytest

import laglab
from laglab.results.columns import Columns, columns_of
from laglab.results.station import heard_ticks
from laglab_gateway import ARRIVALS_FILE, CLAIMS_FILE, ROWS
from laglab_station import read_session

TWO_SECONDS = {"duration": 2.0}


def delays(arrivals: Columns, direction: str) -> np.ndarray:
    rows = arrivals["direction"] == direction
    return arrivals["arrived"][rows] - arrivals["tick"][rows]


@pytest.fixture(scope="module")
def radio(tmp_path_factory: pytest.TempPathFactory) -> laglab.Run:
    return laglab.run("lab-radio", TWO_SECONDS, out=tmp_path_factory.mktemp("radio") / "run")


def test_what_memory_keeps_is_what_the_files_hold(radio: laglab.Run) -> None:
    kept = laglab.run("lab-radio", TWO_SECONDS)
    for mine, filed in ((kept.arrivals, radio.arrivals), (kept.claims, radio.claims)):
        assert mine.keys() == filed.keys()
        for name, column in mine.items():
            np.testing.assert_array_equal(column, filed[name], err_msg=name)
            assert column.dtype.kind == filed[name].dtype.kind


def test_the_tables_begin_with_the_columns_that_others_read(tmp_path: Path) -> None:
    laglab.run("lab-radio", TWO_SECONDS | {"estimator.compare": ["ekf"]}, out=tmp_path / "run")
    laglab.run("fig6", {"duration": 0.1, "pace": "realtime"}, out=tmp_path / "clock")
    heads = {each.name: each.read_text().split("\n")[0] for each in tmp_path.glob("*/*.csv")}
    claimed = "p_xx,p_xy,p_xt,p_yy,p_yt,p_tt"
    assert heads == {
        "trace.csv": "tick,time,x,y,theta,x_meas,y_meas,theta_meas,x_est,y_est,theta_est,"
        "v_sent,omega_sent,v,omega",
        "arrivals.csv": "direction,tick,arrived,time,refused",
        "claims.csv": f"tick,time,{claimed}",
        "link.csv": "direction,tick,frame,copy,size,fate,extra",
        "timing.csv": "tick,lateness,answer",
        "shadow-ekf.csv": f"tick,x,y,theta,{claimed}",
    }


def test_over_udp_the_same_files_byte_for_byte(radio: laglab.Run, tmp_path: Path) -> None:
    laglab.run("lab-radio", TWO_SECONDS, "udp", tmp_path / "udp")
    assert radio.directory is not None
    for name in (ARRIVALS_FILE, CLAIMS_FILE):
        assert (tmp_path / "udp" / name).read_bytes() == (radio.directory / name).read_bytes()


def test_every_arrival_is_one_that_the_audit_counted(radio: laglab.Run) -> None:
    link = radio.summary.link
    assert link is not None
    for direction, audit in (("command", link.command), ("measurement", link.measurement)):
        late = delays(radio.arrivals, direction)
        assert audit.measured is not None
        assert len(late) == audit.arrived
        assert (late.min(), late.max()) == (audit.measured.min, audit.measured.max)
    why = radio.arrivals["refused"][radio.arrivals["direction"] == "command"]
    assert {str(each) for each in why} == {"no", *link.refused}
    assert {each: int((why == each).sum()) for each in link.refused} == link.refused


def test_every_estimate_has_its_claim(radio: laglab.Run) -> None:
    there = ~np.isnan(radio.trace["x_est"])
    np.testing.assert_array_equal(radio.claims["tick"], radio.trace["tick"][there])
    np.testing.assert_array_equal(radio.claims["time"], radio.trace["time"][there])
    assert (radio.claims["p_xx"] > 0).all()


def test_the_log_tells_what_the_gateway_noted(tmp_path: Path) -> None:
    """A station alone, and replay, have it from there: a command is known by its first echo."""
    run = laglab.run("lab", TWO_SECONDS, out=tmp_path / "run")
    rows = list(heard_ticks(read_session(tmp_path / "run" / "robot.tlog"), 0.01))
    claims = columns_of([row for each in rows for row in each.claims], ROWS[CLAIMS_FILE])
    for name, column in run.claims.items():
        np.testing.assert_array_equal(claims[name], column, err_msg=name)
    told = {row for each in rows for row in each.arrivals}
    noted = {tuple(row) for row in zip(*run.arrivals.values(), strict=True)}
    assert told <= noted
    assert len(noted - told) < 40  # echoes of the last commands are still on their way


def test_an_emergency_stop_is_noted_with_its_tick() -> None:
    from laglab_gateway.record.audit import Audit, DirectionAudit

    audit = Audit(DirectionAudit(0), DirectionAudit(0))
    told = [audit.emergency_stopped(stops, tick) for tick, stops in enumerate((0, 1, 1, 2, 2, 2))]
    assert told == [False, True, False, True, False, False]
    assert (audit.report().emergency_stops, audit.report().emergency_ticks) == (2, [1, 3])


def test_without_an_estimate_nothing_is_claimed(tmp_path: Path) -> None:
    run = laglab.run("fig4", {"duration": 0.1}, out=tmp_path / "run")
    assert not (tmp_path / "run" / CLAIMS_FILE).exists()
    assert all(len(column) == 0 for column in run.claims.values())
    assert (delays(run.arrivals, "command") == 0).all()
