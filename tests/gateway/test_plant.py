"""The real robot in the same place: our commands, each a process, in front of the robot in C."""

import json
import re
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from laglab_gateway import Trace, read_trace
from laglab_protocol import Command, End, Measurement, Tick, read_tlog

Process = Any
Start = Callable[..., Process]
LAGLAB = (sys.executable, "-m", "laglab")
SPEED = 4
N, M = 10, 20


class Rig(NamedTuple):
    gateway: Process
    station: Process
    robot: Process


def port_of(gateway: Process) -> str:
    found = re.search(r"listening on udpin://127\.0\.0\.1:(\d+)", gateway.stderr.readline())
    assert found
    return found[1]


@pytest.fixture
def rig(start: Start, firmware: Path, tmp_path: Path) -> Callable[..., Rig]:
    """The scenario `lab`: gateway, controller, and the robot on the gateway's pty."""

    def call(*options: str) -> Rig:
        lab = ("lab", "-n", str(N), "-m", str(M), *options)
        plant = ("--plant", f"pty://{tmp_path}/port", "--out", "run")
        gateway = start(*LAGLAB, "gateway", *lab, *plant, "--endpoint", "udpin://127.0.0.1:0")
        address = f"udpout://127.0.0.1:{port_of(gateway)}"
        robot = start(firmware, "--speed", SPEED, tmp_path / "port")
        return Rig(gateway, start(*LAGLAB, "controller", *lab, "--endpoint", address), robot)

    return call


def wait_until(tmp_path: Path, condition: Callable[[Trace], bool]) -> None:
    """Until the trace has rows that fulfil the condition."""
    path = tmp_path / "run" / "trace.csv"
    deadline = time.monotonic() + 20
    while time.monotonic() < deadline:
        if path.exists() and path.read_bytes().count(b"\n") > 2 and condition(read_trace(path)):
            return
        time.sleep(0.02)
    raise AssertionError("the robot does not get there")


def is_driving(trace: Trace) -> bool:
    return bool(trace["v"][-1] > 0.5)


def ended(process: Process, code: int) -> str:
    """Its standard error, once it has ended as it should."""
    _, errors = process.communicate(timeout=20)
    assert process.returncode == code, errors
    assert "Traceback" not in errors
    return str(errors)


def assert_robot_let_go(robot: Process) -> None:
    assert "the far end is gone" in ended(robot, 1)


def test_the_same_controller_stabilises_a_real_robot(
    rig: Callable[..., Rig], tmp_path: Path
) -> None:
    gateway, station, robot = rig("--duration", "12")
    assert "completed at tick 1200" in ended(gateway, 0)
    ended(station, 0)
    assert_robot_let_go(robot)
    assert not (tmp_path / "port").is_symlink()

    trace = read_trace(tmp_path / "run" / "trace.csv")
    assert trace["tick"].tolist() == list(range(1201))
    for axis, there in (("x", -3.0), ("y", -3.0), ("theta", 0.0)):
        assert np.isnan(trace[axis]).all(), "nobody knows the true pose"
        assert trace[f"{axis}_meas"][:10].mean() == pytest.approx(there, abs=0.02)
        assert trace[f"{axis}_meas"][-100:].mean() == pytest.approx(0.0, abs=0.05)
    assert_the_stamps_tell_the_delays(tmp_path / "run" / "robot.tlog")


def assert_the_stamps_tell_the_delays(log: Path) -> None:
    """By the frames on the station's link: s and k are the robot's, the echo is its word."""
    messages = [frame.message for _, frame in read_tlog(log)]
    tick, measured, echoed = 0, set(), {}
    for message in reversed(messages):
        match message:
            case Tick():
                tick = message.tick
            case Measurement():
                measured.add(tick - message.tick)
                echoed[message.command_tick] = message.tick - 1 - message.command_tick
    assert measured == {M}
    in_force_after = [delay for stamp, delay in echoed.items() if stamp >= 0]
    # An answer that comes after the robot's next tick, on a busy machine, is that much later.
    assert min(in_force_after) == N
    assert np.median(in_force_after) == N
    assert {type(message) for message in messages} > {Command, Measurement, Tick, End}


def test_a_run_with_a_real_robot_says_that_its_pose_is_measured(
    start: Start, firmware: Path, tmp_path: Path
) -> None:
    port = tmp_path / "port"
    plant = ("--plant", f"pty://{port}", "--duration", "2", "--out", "run")
    run = start(*LAGLAB, "run", "lab", *plant)
    while not port.is_symlink():
        assert run.poll() is None
        time.sleep(0.02)
    robot = start(firmware, "--speed", SPEED, port)
    said, errors = run.communicate(timeout=30)
    assert run.returncode == 0, errors
    assert "as measured" in said
    assert_robot_let_go(robot)
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert (summary["pose"], summary["ticks"]) == ("measured", 200)
    assert summary["final"]["rho"] > 2
    assert summary["rms_error"]["x"] < 0.03
    link = summary["link"]
    assert link["measurement"]["measured"]["mean"] == M
    assert N <= link["command"]["measured"]["mean"] < N + 1
    assert link["timesync"]["samples"] > 0
    assert (tmp_path / "run" / "figure.png").exists()


def test_a_dead_robot_is_named_by_its_link_and_the_station_is_told(
    rig: Callable[..., Rig], tmp_path: Path
) -> None:
    gateway, station, robot = rig("--duration", "600")
    wait_until(tmp_path, is_driving)
    robot.kill()
    killed = time.monotonic()
    errors = ended(gateway, 4)
    assert time.monotonic() - killed < 4
    last = int(read_trace(tmp_path / "run" / "trace.csv")["tick"][-1]) + 1
    assert f"pty://{tmp_path}/port: the robot has been silent since its tick {last}" in errors
    assert ended(station, 1)


def test_a_dead_station_lets_the_robot_stop_by_its_own_failsafe(
    rig: Callable[..., Rig], tmp_path: Path
) -> None:
    gateway, station, robot = rig("--duration", "600")
    wait_until(tmp_path, is_driving)
    station.kill()
    assert "the controller has been silent since tick" in ended(gateway, 4)
    assert_robot_let_go(robot)
    trace = read_trace(tmp_path / "run" / "trace.csv")
    last_sent = int(trace["tick"][np.isfinite(trace["v_sent"])][-1])
    v = trace["v"][last_sent + N : last_sent + N + 150]
    assert v[0] > 0.5
    assert (v[:40] == v[0]).all()
    assert (np.diff(v[55:95]) < 0).all(), "a ramp, not a jump"
    assert (v[105:] == 0).all()
    assert np.ptp(trace["x_meas"][last_sent + N + 110 :]) < 0.1, "it stands"


def test_ctrl_c_reaches_both_sides(start: Start, tmp_path: Path) -> None:
    """The robot is our own gateway in real time, reached by UDP, so that it can tell its end."""
    lab = ("lab", "--duration", "600")
    pace = ("-n", "0", "-m", "0", "--pace", "realtime")
    robot = start(*LAGLAB, "gateway", *lab, *pace, "--endpoint", "udpin://127.0.0.1:0")
    plant = ("--plant", f"udpout://127.0.0.1:{port_of(robot)}", "--out", "run")
    gateway = start(*LAGLAB, "gateway", *lab, *plant, "--endpoint", "udpin://127.0.0.1:0")
    address = f"udpout://127.0.0.1:{port_of(gateway)}"
    station = start(*LAGLAB, "controller", *lab, "--endpoint", address)
    wait_until(tmp_path, is_driving)
    gateway.send_signal(signal.SIGINT)
    for side in (gateway, station, robot):
        ended(side, 130)
    assert "interrupted at tick" in ended(robot, 130)


def test_a_robot_that_never_speaks_is_named(start: Start, tmp_path: Path) -> None:
    lab = ("lab", "--silence", "1")
    plant = ("--plant", f"pty://{tmp_path}/port")
    gateway = start(*LAGLAB, "gateway", *lab, *plant, "--endpoint", "udpin://127.0.0.1:0")
    address = f"udpout://127.0.0.1:{port_of(gateway)}"
    start(*LAGLAB, "controller", *lab, "--endpoint", address)
    assert f"pty://{tmp_path}/port: the robot never spoke" in ended(gateway, 4)


def test_a_run_in_one_process_cannot_have_a_robot_with_a_clock(
    start: Start, tmp_path: Path
) -> None:
    run = start(*LAGLAB, "run", "lab", "--transport", "inline", "--plant", f"pty://{tmp_path}/port")
    assert "take --transport udp or serial" in ended(run, 2)
