"""Two sides meet: they compare what they were told, take over from each other, meet again."""

import json
import re
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from laglab_gateway import read_trace
from laglab_protocol import (
    STATION_COMPONENT,
    STATION_SYSTEM,
    End,
    EndReason,
    Heartbeat,
    Sender,
    Tick,
    frames_in,
    open_endpoint,
)

Process = "subprocess.Popen[str]"
Start = Callable[..., "subprocess.Popen[str]"]
ListeningPort = Callable[["subprocess.Popen[str]"], str]
HERE = ("--endpoint", "udpin://127.0.0.1:0")
HEARTBEAT = Heartbeat(0, 6, 8, 0, 4, 3)


def there(port: str) -> tuple[str, str]:
    return ("--endpoint", f"udpout://127.0.0.1:{port}")


def ended(process: "subprocess.Popen[str]", code: int) -> str:
    """All that it said."""
    output, errors = process.communicate(timeout=30)
    assert process.returncode == code, errors
    assert "Traceback" not in errors
    return output + errors


def wait_for(done: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 20
    while not done():
        assert time.monotonic() < deadline
        time.sleep(0.05)


def rows(folder: Path) -> int:
    trace = folder / "trace.csv"
    return trace.read_bytes().count(b"\n") - 1 if trace.exists() else 0


def last_tick(folder: Path) -> int:
    return int((folder / "trace.csv").read_text().splitlines()[-1].split(",")[0])


def test_with_different_sample_times_both_refuse(
    start: Start, listening_port: ListeningPort
) -> None:
    gateway = start("gateway", "fig6", *HERE)
    options = ("fig6", "--set", "sample_time=0.02")
    station = start("controller", *options, *there(listening_port(gateway)))
    line = "laglab: the sample time is 0.01 s for the robot and 0.02 s for the controller: "
    for side in (gateway, station):
        said = ended(side, 2)
        assert line in said
        assert said.count("sample time is") == 1


def test_every_other_difference_is_one_warning_on_both_sides_and_in_the_summaries(
    start: Start, listening_port: ListeningPort, tmp_path: Path
) -> None:
    options = ("fig6", "--duration", "1")
    gateway = start("gateway", *options, *HERE, "--out", "robot")
    station = start(
        "controller",
        *(*options, "-n", "12", "--set", "plant.track=0.5", "--out", "station"),
        *there(listening_port(gateway)),
    )
    expected = (
        "track: 0.6 m for the robot, 0.5 m for the controller; "
        "n: 10 ticks for the robot, 12 ticks for the controller"
    )
    for side, folder in ((gateway, "robot"), (station, "station")):
        said = ended(side, 0)
        assert len(re.findall(r"^warning: the two sides were told", said, re.MULTILINE)) >= 1
        assert expected in " ".join(said.split())
        (warning,) = json.loads((tmp_path / folder / "summary.json").read_text())["warnings"]
        assert expected in warning


def test_each_side_alone_leaves_a_run(
    start: Start, listening_port: ListeningPort, tmp_path: Path
) -> None:
    """With table, verdict and figure; the station's as far as it knows."""
    options = ("lab", "--duration", "6")
    gateway = start("gateway", *options, *HERE, "--out", "robot")
    station = start("controller", *options, *there(listening_port(gateway)), "--out", "station")
    for side, folder, seen in ((gateway, "robot", "true"), (station, "station", "measured")):
        said = ended(side, 0)
        assert re.search(r"^converged: at the end", said, re.MULTILINE)
        assert f"results in {folder}" in said
        files = {each.name for each in (tmp_path / folder).iterdir()}
        assert files >= {"scenario.toml", "trace.csv", "robot.tlog", "summary.json", "figure.png"}
        summary = json.loads((tmp_path / folder / "summary.json").read_text())
        assert (summary["pose"], summary["ticks"]) == (seen, 600)
    robot, station_ = (read_trace(tmp_path / side / "trace.csv") for side in ("robot", "station"))
    m = 20
    for column in ("x_meas", "x_est", "v_sent", "omega_sent"):
        np.testing.assert_array_equal(station_[column][:-m], robot[column][:-m], err_msg=column)
    np.testing.assert_array_equal(station_["v"][: -m - 1], robot["v"][: -m - 1])
    assert np.isnan(station_["x"]).all()


@pytest.mark.parametrize(
    ("side", "waits", "does"),
    [
        ("gateway", "udpin", "waiting for the controller, which calls there (udpout)"),
        ("gateway", "udpout", "waiting for the controller, which listens there (udpin)"),
        ("controller", "udpin", "waiting for the robot, which calls there (udpout)"),
        ("controller", "udpout", "waiting for the robot, which listens there (udpin)"),
    ],
)
def test_who_waits_says_for_whom_and_what_it_is_to_do(
    start: Start, free_port: int, side: str, waits: str, does: str
) -> None:
    """Two sides that both listen, or both call, never meet."""
    waiting = start(side, "fig6", "--endpoint", f"{waits}://127.0.0.1:{free_port}")
    assert waiting.stderr is not None
    assert does in waiting.stderr.readline()
    waiting.send_signal(signal.SIGINT)
    assert ended(waiting, 130).splitlines()[-1] == "laglab: interrupted"


@pytest.fixture
def free_port() -> int:
    with open_endpoint("udpin://127.0.0.1:0") as endpoint:
        return int(endpoint.name.rpartition(":")[2])


@pytest.mark.slow
@pytest.mark.parametrize("transport", ["udpin", "udpout", "pty"])
@pytest.mark.parametrize("pace", ["lockstep", "realtime"])
def test_a_robot_that_begins_again_is_met_anew(
    start: Start, tmp_path: Path, free_port: int, transport: str, pace: str
) -> None:
    """Killed in the middle of its way, started again; the station is still there."""
    robot_url, station_url = {
        "udpin": (f"udpin://127.0.0.1:{free_port}", f"udpout://127.0.0.1:{free_port}"),
        "udpout": (f"udpout://127.0.0.1:{free_port}", f"udpin://127.0.0.1:{free_port}"),
        "pty": ("pty://port", "serial://port:57600"),
    }[transport]
    options = ("lab", "--pace", pace, "--speed", "5", "--silence", "8")
    first = start("gateway", *options, "--endpoint", robot_url, "--out", "first")
    wait_for(lambda: transport != "pty" or (tmp_path / "port").is_symlink())
    station = start("controller", *options, "--endpoint", station_url, "--out", "station")
    wait_for(lambda: rows(tmp_path / "first") > 150)
    first.kill()
    first.wait(5)
    second = start("gateway", *options, "--endpoint", robot_url, "--out", "second")
    assert "converged: at the end" in ended(second, 0)
    assert last_tick(tmp_path / "second") == 2000
    assert "warning: the robot has begun again" in ended(station, 0)


@pytest.mark.slow
def test_a_displaced_station_is_told_and_can_come_back(
    start: Start, listening_port: ListeningPort, tmp_path: Path
) -> None:
    options = ("lab", "--pace", "realtime", "--duration", "60", "--silence", "9")
    watch = ("--watch", "udpin://127.0.0.1:0")
    gateway = start("gateway", *options, *HERE, *watch, "--out", "run")
    link, watched = (there(listening_port(gateway)) for _ in range(2))
    first = start("controller", *options, *link, "--out", "first")
    wait_for(lambda: rows(tmp_path / "run") > 50)

    second = start("controller", *options, *link, "--out", "second")
    assert second.stderr is not None
    said = [second.stderr.readline() for _ in range(2)]
    assert "another station has the robot: calling until it lets go" in said[1]

    first.send_signal(signal.SIGSTOP)
    with open_endpoint(watched[1]) as watcher:
        watcher.send(Sender(255, 190).frame(HEARTBEAT))
        wait_for(lambda: (tmp_path / "second/robot.tlog").stat().st_size > 2000)
        seen = b"".join(iter(lambda: watcher.receive(0.0), b""))
    first.send_signal(signal.SIGCONT)
    assert "another station has taken over" in ended(first, 4)
    assert b"another station has taken over" in seen

    second.send_signal(signal.SIGSTOP)
    third = start("controller", *options, *link, "--out", "third")
    wait_for(
        lambda: (
            (tmp_path / "third/robot.tlog").exists()
            and (tmp_path / "third/robot.tlog").stat().st_size > 2000
        )
    )
    third.send_signal(signal.SIGINT)
    ended(third, 130)
    assert "warning: another station has taken over" in ended(gateway, 130)
    second.kill()
    assert "taken over" not in second.communicate()[1], "it is the other one"


def test_an_end_ends_no_gateway_that_waits_and_no_run_that_it_is_not_of(
    start: Start, listening_port: ListeningPort
) -> None:
    gateway = start("gateway", "fig6", "--duration", "0.5", *HERE, "--out", "run")
    sender = Sender(STATION_SYSTEM, STATION_COMPONENT)
    with open_endpoint(f"udpout://127.0.0.1:{listening_port(gateway)}") as past:
        for tick in (0, 7, 1000):
            past.send(sender.frame(End(tick, EndReason.DIVERGED)))
        time.sleep(0.3)
        assert past.receive(0.0) == b""  # it is no station's call
        past.send(sender.frame(HEARTBEAT))
        while not any(isinstance(each.message, Tick) for each in frames_in(past.receive(2.0))):
            pass
        past.send(sender.frame(End(1000, EndReason.DIVERGED)))
        time.sleep(0.3)
        assert gateway.poll() is None
        past.send(sender.frame(End(0, EndReason.DIVERGED)))
        assert "stopped at tick 0" in ended(gateway, 3)


SERIAL = "serial://{}:115200"


@pytest.fixture
def cable(start: Start, tmp_path: Path) -> None:
    """From port `one` to port `two`."""
    start("serial", "one", "two", "--baud", "115200")
    wait_for((tmp_path / "two").is_symlink)


@pytest.mark.parametrize("first", ["gateway", "controller"])
@pytest.mark.parametrize("differing", ["sample_time=0.02", "plant.track=0.7"])
@pytest.mark.usefixtures("cable")
def test_on_a_line_where_all_comes_in_pieces_they_compare_before_they_begin(
    start: Start, tmp_path: Path, first: str, differing: str
) -> None:
    options = {
        "gateway": ("--endpoint", SERIAL.format("one")),
        "controller": ("--endpoint", SERIAL.format("two"), "--set", differing),
    }
    sides = {}
    for side in (first, *(options.keys() - {first})):
        short = ("fig6", "--duration", "0.5", "--silence", "9", "--out", side)
        sides[side] = start(side, *short, *options[side])
        if side == first:
            assert "waiting for" in sides[side].stderr.readline()
    code = 2 if differing.startswith("sample_time") else 0
    said = [ended(process, code) for process in sides.values()]
    for each in said:
        assert "tell its settings" not in each
        assert differing.partition("=")[2] in each
    assert (tmp_path / "gateway").exists() == (tmp_path / "controller").exists() == (code == 0)


@pytest.mark.parametrize("differing", ["sample_time=0.02", "plant.track=0.7"])
@pytest.mark.usefixtures("cable")
def test_a_real_robot_at_the_end_of_a_line_is_compared_with_before_it_begins(
    start: Start, listening_port: ListeningPort, differing: str
) -> None:
    """Another gateway, on a clock of its own, is the robot."""
    clock = ("--pace", "realtime", "-n", "0", "-m", "0", "--duration", "2", "--set", differing)
    robot = start("gateway", "lab", *clock, "--endpoint", SERIAL.format("one"), "--out", "robot")
    assert "waiting for" in robot.stderr.readline()
    lab = ("lab", "--duration", "1")
    relay = start("gateway", *lab, "--plant", SERIAL.format("two"), *HERE, "--out", "relay")
    start("controller", *lab, *there(listening_port(relay)), "--out", "station")
    code = 2 if differing.startswith("sample_time") else 0
    for side in (robot, relay):
        said = ended(side, code)
        assert "tell its settings" not in said
        assert differing.partition("=")[2] in said
