"""MAVProxy, with our dialect and all that it loads by default, as a person uses it."""

import queue
import re
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from .asked import Asked

PATIENCE = 20.0


class MavProxy:
    """The program, spoken to as a person does."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        assert process.stdin is not None
        self._stdin = process.stdin
        self._lines: queue.Queue[str] = queue.Queue()
        self._process = process
        self._heard: list[str] = []
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            self._lines.put(line)

    def say(self, line: str) -> None:
        self._stdin.write(line + "\n")
        self._stdin.flush()

    def hears(self, pattern: str) -> re.Match[str]:
        """The next line in which `pattern` is found."""
        deadline = time.monotonic() + PATIENCE
        while (left := deadline - time.monotonic()) > 0:
            try:
                self._heard.append(self._lines.get(timeout=left))
            except queue.Empty:
                break
            if match := re.search(pattern, self._heard[-1]):
                return match
        raise AssertionError(f"no {pattern!r} in:\n{''.join(self._heard)}")

    @property
    def said(self) -> str:
        """All that was heard of it so far."""
        return "".join(self._heard)

    def end(self) -> None:
        self._process.kill()
        self._reader.join()


@pytest.fixture
def mavproxy(port: int, tmp_path: Path) -> Iterator[MavProxy]:
    beside = Path(sys.executable).parent / "mavproxy.py"
    script = beside if beside.is_file() else shutil.which("mavproxy.py")
    assert script, "MAVProxy is not installed: pip install laglab[test]"
    options = [
        f"--master=udp:127.0.0.1:{port}",
        f"--state-basedir={tmp_path}",
        "--aircraft=rover",
    ]
    with subprocess.Popen(
        [sys.executable, "-m", "laglab_protocol.pymavlink", script, *options],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        cwd=tmp_path,
    ) as process:
        running = MavProxy(process)
        yield running
        running.end()


def wait_until(done: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE
    while not done():
        assert time.monotonic() < deadline, "in vain"
        time.sleep(0.1)


def north_and_east(mavproxy: MavProxy) -> tuple[float, float]:
    mavproxy.say("status LOCAL_POSITION_NED")
    match = mavproxy.hears(
        r"LOCAL_POSITION_NED \{time_boot_ms : \d+, x : ([-\d.e]+), y : ([-\d.e]+)"
    )
    return float(match[1]), float(match[2])


@pytest.mark.slow
def test_mavproxy_asks_for_everything_and_sees_it_move(mavproxy: MavProxy, rover: Asked) -> None:
    mavproxy.hears("Detected vehicle 1:1")
    mavproxy.hears("Received 5 parameters")
    for line, answer in {
        "fence list": "Requesting 0 fence items",
        "wp list": "Requesting 0 waypoints",
        "rally list": "Requesting 0 rally items",
        "wp clear": "MISSION_ACK: TYPE_MISSION: ACCEPTED",
        "log list": "No logs",
        "version": "REQUEST_MESSAGE: ACCEPTED",
        "mode MANUAL": "DO_SET_MODE: DENIED",
        "arm safetyon": "DO_SET_MODE: DENIED",
        "ftp list /": "opcode:129",
        "status GPS_RAW_INT": r"fix_type : 3, lat : 21037\d+, lon : 105781\d+",
        "status HOME_POSITION": "latitude : 210380000, longitude : 1057820000",
    }.items():
        mavproxy.say(line)
        mavproxy.hears(answer)
    mavproxy.say("set streamrate 2")
    wait_until(lambda: any(each.name == "REQUEST_DATA_STREAM" for each in rover.requests))

    mavproxy.say("param set V_MAX 1.5")
    time.sleep(0.5)  # it sends, and tells nothing when it is confirmed
    mavproxy.say("param show V_MAX")
    mavproxy.hears(r"V_MAX +1\.5")

    assert north_and_east(mavproxy) == (-2.0, -3.0)
    mavproxy.say("arm throttle")
    mavproxy.hears("COMPONENT_ARM_DISARM: ACCEPTED")
    mavproxy.hears("ARMED")
    wait_until(lambda: north_and_east(mavproxy) != (-2.0, -3.0))

    mavproxy.say("disarm")
    mavproxy.hears("DISARMED")
    assert "breach" not in mavproxy.said
    rover.check_against_table("MAVProxy")
