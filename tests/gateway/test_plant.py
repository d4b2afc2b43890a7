"""The real robot in the same place: our commands, each a process, in front of the robot in C."""

import json
import signal
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from laglab.runs.plant import FmuPlant
from laglab_fmu import Robot, RobotParameters
from laglab_gateway import (
    Gateway,
    GatewayConfig,
    Outcome,
    Patience,
    PlantSilentError,
    Recorder,
    Relay,
    Safety,
    Services,
    Surroundings,
    Trace,
    read_trace,
    serve_realtime,
    serve_remote,
    standard_parameters,
)
from laglab_protocol import (
    STATION_COMPONENT,
    STATION_HEARTBEAT,
    STATION_SYSTEM,
    Command,
    End,
    EndReason,
    Listener,
    Measurement,
    Receiver,
    Sender,
    Tick,
    frames_in,
    open_endpoint,
    read_tlog,
)
from laglab_protocol.endpoints.udp import UdpIn

Process = Any
Start = Callable[..., Process]
ListeningPort = Callable[[Process], str]
LAGLAB = (sys.executable, "-m", "laglab")
FAST, UNHURRIED = 4, 2
N, M = 10, 20


class Rig(NamedTuple):
    gateway: Process
    station: Process
    robot: Process


@pytest.fixture
def rig(
    start: Start, listening_port: ListeningPort, firmware: Path, tmp_path: Path
) -> Callable[..., Rig]:
    """The scenario `lab`: gateway, controller, and the robot on the gateway's pty."""

    def call(*options: str, speed: int = FAST) -> Rig:
        lab = ("lab", "-n", str(N), "-m", str(M), *options)
        plant = ("--plant", f"pty://{tmp_path}/port", "--out", "run")
        gateway = start(*LAGLAB, "gateway", *lab, *plant, "--endpoint", "udpin://127.0.0.1:0")
        address = f"udpout://127.0.0.1:{listening_port(gateway)}"
        robot = start(firmware, "--speed", speed, tmp_path / "port")
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
    """What it said, once it has ended as it should."""
    output, errors = process.communicate(timeout=50)
    assert process.returncode == code, errors
    assert "Traceback" not in errors
    return str(output + errors)


def assert_robot_let_go(robot: Process) -> None:
    assert "the far end is gone" in ended(robot, 1)


@pytest.mark.slow
def test_the_same_controller_stabilises_a_real_robot(
    rig: Callable[..., Rig], tmp_path: Path
) -> None:
    gateway, station, robot = rig("--duration", "15", speed=UNHURRIED)
    assert "1500 ticks in" in ended(gateway, 0)
    ended(station, 0)
    assert_robot_let_go(robot)
    assert not (tmp_path / "port").is_symlink()

    trace = read_trace(tmp_path / "run" / "trace.csv")
    assert trace["tick"].tolist() == list(range(1501))
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
    robot = start(firmware, "--speed", UNHURRIED, port)
    said, errors = run.communicate(timeout=30)
    assert run.returncode == 0, errors
    assert "rad as measured over the last second" in " ".join(said.split())
    assert_robot_let_go(robot)
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert (summary["pose"], summary["ticks"]) == ("measured", 200)
    assert 'pace = "realtime"' in (tmp_path / "run" / "scenario.toml").read_text()
    trace = np.genfromtxt(tmp_path / "run" / "trace.csv", delimiter=",", names=True)
    late = trace[trace["time"] >= trace["time"][-1] - 1.0]
    rho = np.hypot(np.nanmean(late["x_meas"]), np.nanmean(late["y_meas"]))
    assert summary["final"]["rho"] == pytest.approx(rho)
    assert summary["rms_error"]["x"] < 0.03
    link = summary["link"]
    measured = {direction: link[direction]["measured"] for direction in ("command", "measurement")}
    told = (measured["measurement"]["mean"], measured["command"]["min"])
    assert (*told, link["timesync"]["samples"] > 0) == (M, N, True)
    assert (tmp_path / "run" / "figure.png").exists()


@pytest.mark.slow
def test_a_dead_robot_is_named_by_its_link_and_the_station_is_told(
    rig: Callable[..., Rig], tmp_path: Path
) -> None:
    gateway, station, robot = rig("--duration", "600")
    wait_until(tmp_path, is_driving)
    robot.kill()
    killed = time.monotonic()
    said = ""
    while "the robot has been silent" not in said:
        said += gateway.stderr.readline()
    assert time.monotonic() - killed < 4
    errors = said + ended(gateway, 4)
    last = int(read_trace(tmp_path / "run" / "trace.csv")["tick"][-1]) + 1
    assert f"pty://{tmp_path}/port: the robot has been silent since its tick {last}" in errors
    assert "the other side failed" in ended(station, 4)


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
    v = trace["v"][last_sent + N :]
    ramp = np.flatnonzero(np.diff(v) < 0)
    assert v[0] > 0.5 > v[-1] == 0
    assert 40 <= ramp[0] <= 100, "after its time-out, and a last command may be late"
    assert list(ramp) == list(range(ramp[0], ramp[0] + 50)), "a ramp, not a jump"
    assert np.ptp(trace["x_meas"][last_sent + N + ramp[-1] + 10 :]) < 0.1, "it stands"


@pytest.fixture
def gateway_as_robot() -> Iterator[tuple[str, "Future[Outcome]"]]:
    """Our own gateway in real time, as a robot on UDP: its address, and its outcome to come."""
    parameters = RobotParameters(start=(-3.0, -3.0, 0.0))
    config = GatewayConfig(0, 0, 6000, parameters.sample_time)

    def drive() -> Outcome:
        with Robot.open(3, parameters) as robot:
            gateway = Gateway(FmuPlant(robot, parameters), config)
            patience = Patience(silence=10.0, connect=20.0)
            around = Surroundings(Listener(endpoint, Receiver()), patience=patience)
            return serve_realtime(gateway, around, parameters.sample_time).outcome

    with open_endpoint("udpin://127.0.0.1:0") as endpoint, ThreadPoolExecutor(1) as thread:
        yield endpoint.name.replace("udpin", "udpout"), thread.submit(drive)


def test_ctrl_c_reaches_both_sides(
    start: Start,
    listening_port: ListeningPort,
    tmp_path: Path,
    gateway_as_robot: tuple[str, "Future[Outcome]"],
) -> None:
    address, robot = gateway_as_robot
    lab = ("lab", "--duration", "600")
    plant = ("--plant", address, "--out", "run")
    gateway = start(*LAGLAB, "gateway", *lab, *plant, "--endpoint", "udpin://127.0.0.1:0")
    address = f"udpout://127.0.0.1:{listening_port(gateway)}"
    station = start(*LAGLAB, "controller", *lab, "--endpoint", address)
    wait_until(tmp_path, is_driving)
    gateway.send_signal(signal.SIGINT)
    assert "interrupted at tick" in ended(gateway, 130)
    ended(station, 130)
    assert robot.result(timeout=5).reason is EndReason.INTERRUPTED


class HeldUp(Recorder):
    """A disk that takes its time, once."""

    flushed = 0

    def flush(self) -> None:
        self.flushed += 1
        if self.flushed == 30:
            time.sleep(1.3)


def test_who_is_held_up_does_not_take_the_robot_for_silent(
    gateway_as_robot: tuple[str, "Future[Outcome]"], monkeypatch: pytest.MonkeyPatch
) -> None:
    """It has gone on meanwhile, and what it said is there to be read, each frame a datagram."""
    address, robot = gateway_as_robot
    together = UdpIn.send

    def one_by_one(link: UdpIn, data: bytes, to: Any = None) -> None:
        for frame in frames_in(data):
            together(link, frame.raw, to)

    monkeypatch.setattr(UdpIn, "send", one_by_one)
    services = Services(standard_parameters(1, 1, Safety()), placeable=False)
    relay, recorder = Relay(GatewayConfig(1, 1, 200, 0.01), services), HeldUp()
    with (
        open_endpoint(address) as line,
        open_endpoint("udpin://127.0.0.1:0") as endpoint,
        open_endpoint(endpoint.name.replace("udpin", "udpout")) as station,
    ):
        station.send(Sender(STATION_SYSTEM, STATION_COMPONENT).frame(STATION_HEARTBEAT))
        around = Surroundings(Listener(endpoint, Receiver()), recorder, Patience(silence=3.6))
        served = serve_remote(relay, Listener(line, Receiver()), around)
    assert recorder.flushed > 100
    assert served.outcome.reason is EndReason.COMPLETED
    assert robot.result(timeout=5).reason is EndReason.COMPLETED


def test_a_robot_that_never_speaks_is_named(tmp_path: Path) -> None:
    services = Services(standard_parameters(1, 1, Safety()), placeable=False)
    relay = Relay(GatewayConfig(1, 1, 100, 0.01), services)
    link = f"pty://{tmp_path}/port"
    with (
        open_endpoint(link) as robot,
        open_endpoint("udpin://127.0.0.1:0") as endpoint,
        open_endpoint(endpoint.name.replace("udpin", "udpout")) as station,
    ):
        station.send(Sender(STATION_SYSTEM, STATION_COMPONENT).frame(STATION_HEARTBEAT))
        around = Surroundings(Listener(endpoint, Receiver()), patience=Patience(silence=0.9))
        with pytest.raises(PlantSilentError, match="the robot never spoke") as silent:
            serve_remote(relay, Listener(robot, Receiver()), around)
        assert link in str(silent.value)
        assert End(0, EndReason.FAILED) in [f.message for f in frames_in(station.receive(0.1))]
