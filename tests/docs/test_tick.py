"""A run does what the table in docs/tick.md says."""

import re
from pathlib import Path

import numpy as np
import pytest

from laglab.command import main
from laglab_gateway import read_trace
from laglab_protocol import Command, Measurement
from laglab_station import read_session

PAGE = Path(__file__).parents[2] / "docs" / "tick.md"
ROWS = [
    re.split(r" *\| *", line.strip("| "))
    for line in PAGE.read_text(encoding="utf-8").splitlines()
    if re.match(r"\| \d+ \| z_", line)
]
NOTHING, STANDSTILL = "nothing", "standstill"


def spelled(letter: str, tick: int) -> str:
    return f"{letter}_{tick}"


def echoed(measurement: Measurement) -> str:
    tick = measurement.command_tick
    return STANDSTILL if tick < 0 else spelled("u", tick)


def sent(command: Command | None) -> str:
    return NOTHING if command is None else spelled("u", command.tick)


def test_the_table_is_a_run(tmp_path: Path) -> None:
    out = tmp_path / "run"
    ask = ["run", "fig6", "-n", "1", "-m", "2", "--duration", "0.1", "--transport", "inline"]
    with pytest.raises(SystemExit, match="0"):
        main([*ask, "--out", str(out)])
    session, trace = list(read_session(out / "robot.tlog")), read_trace(out / "trace.csv")
    echoes = {z.tick: echoed(z) for heard in session for z in heard.measurements}
    assert len(ROWS) == 6
    for k, (tick, sampled, arrives, echo, command, in_force) in enumerate(ROWS):
        came = session[k].measurements
        assert (int(tick), sampled) == (k, spelled("z", k))
        assert arrives == (spelled("z", came[0].tick) if came else NOTHING)
        assert echo == (echoed(came[0]) if came else NOTHING)
        assert command == sent(session[k].command)
        assert in_force == echoes[k + 1]
        stamp = None if in_force == STANDSTILL else int(in_force.removeprefix("u_"))
        speed = 0.0 if stamp is None else trace["v_sent"][stamp]
        np.testing.assert_equal(trace["v"][k], speed)
