"""What is left of a run whose robot was switched off and on: its ticks begin again."""

from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from laglab.results.columns import beside, columns_of, places, rising
from laglab.results.numbers import COVARIANCE
from laglab.results.shadows import shadow_error
from laglab.results.station import heard_ticks, record_session
from laglab_gateway import ARRIVALS_FILE, CLAIMS_FILE, ROWS, FileRecorder, MemoryRecorder, trace_of
from laglab_gateway.record.audit import DirectionAudit
from laglab_protocol import Command, Estimate, Measurement
from laglab_station import SessionTick, ShadowRow

TS = 0.01
LIVES = (50, 30)
TICKS = [k for ticks in LIVES for k in range(ticks)]
P = (1e-4, 0.0, 0.0, 1e-4, 0.0, 1e-4)


def heard(tick: int, life: int) -> SessionTick:
    """The robot stands at x = its life, and says so."""
    z = Measurement(float(life), 0.0, 0.0, 0.1, 0.0, tick, tick - 1)
    estimate = Estimate(float(life), 0.0, 0.0, *P, tick=tick)
    return SessionTick(tick, (z,), Command(0.1, 0.0, tick, 1, 1, 1), estimate)


@pytest.fixture
def session() -> list[SessionTick]:
    return [heard(k, life) for life, ticks in enumerate(LIVES) for k in range(ticks)]


def test_its_time_goes_on(session: list[SessionTick]) -> None:
    recorder = MemoryRecorder()
    record_session(session, TS, recorder)
    trace = trace_of(recorder.rows)
    assert trace["tick"].tolist() == TICKS
    assert trace["time"] == pytest.approx(np.arange(len(TICKS)) * TS)
    lives = np.repeat(range(len(LIVES)), LIVES)
    assert trace["x_est"].tolist() == trace["x_meas"].tolist() == lives.tolist()
    claims = columns_of(recorder.claim_rows, ROWS[CLAIMS_FILE])
    assert not np.isnan(beside(trace["time"], claims, "time", COVARIANCE)["p_xx"]).any()
    arrivals = columns_of(recorder.arrival_rows, ROWS[ARRIVALS_FILE])
    measured = arrivals["direction"] == "measurement"
    assert arrivals["time"][measured].tolist() == trace["time"].tolist()


def test_its_first_commands_are_news_again(session: list[SessionTick]) -> None:
    came = [row for _, rows, _ in heard_ticks(session, TS) for row in rows]
    commands = [row.tick for row in came if row.direction == "command"]
    assert commands == [k for ticks in LIVES for k in range(ticks - 1)]


def test_a_shadow_is_held_against_the_first_of_its_lives() -> None:
    trace = {"tick": np.array(TICKS, dtype=float)}
    trace |= {name: np.arange(len(TICKS), dtype=float) for name in ("x", "y", "theta")}
    perfect = [ShadowRow(k, np.full(3, float(k)), np.eye(3)) for k in range(LIVES[0])]
    errors = shadow_error(perfect, [trace], 0)
    assert errors is not None
    assert (errors.x, errors.y) == (0.0, 0.0)
    there, rows = places(trace["tick"], np.array([3.0, 49.0, 60.0]))
    assert (there.tolist(), rows.tolist()) == ([True, True, False], [3, 49])
    assert len(rising(trace["tick"])) == LIVES[0]


def test_stamps_that_begin_again_are_not_out_of_order() -> None:
    audit = DirectionAudit(0)
    for ticks in LIVES:
        audit.begin_anew()
        for tick in range(ticks):
            audit.arrived(tick, tick)
    assert audit.report().reordered == 0


def test_of_what_there_was_nothing_there_is_no_file(tmp_path: Path) -> None:
    with closing(FileRecorder(tmp_path)) as recorder:
        record_session([SessionTick(0, (), Command(0.0, 0.0, 0, 1, 1, 0))], TS, recorder)
    assert {path.name for path in tmp_path.iterdir()} == {"trace.csv", "robot.tlog"}
