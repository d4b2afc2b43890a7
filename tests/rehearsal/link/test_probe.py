"""A link is measured by processes, over UDP and over serial lines."""

import contextlib
import csv
import signal
import subprocess
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from laglab.link.measured import read_measured
from laglab.link.probing import echo as answer
from laglab.link.probing import ends, real_sizes
from laglab_protocol import (
    NO_PROBE,
    PROBE_FILLER,
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_SYSTEM,
    Codec,
    Command,
    Endpoint,
    Estimate,
    Listener,
    Measurement,
    Probe,
    Sender,
    Tick,
    make_key,
    open_endpoint,
    read_tlog,
)

Ended = Callable[..., Any]


Refused = Callable[..., str]
Start = Callable[..., "subprocess.Popen[str]"]


def test_somebody_is_asked_twice_however_long_the_interval(
    refused: Refused, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with open_endpoint("udpin://127.0.0.1:0") as silent:
        url = silent.name.replace("udpin", "udpout")
        line = refused("link", "probe", url, "--wait", "0.1", "--interval", "0.2", code=4)
        assert [bool(silent.receive(0.0)) for _ in range(3)] == [True, True, False]
    assert "nobody answers (0.4 s)" in line
    assert "it answers one `laglab link probe` at a time" in line


@pytest.fixture
def echoing(start: Start) -> Callable[..., str]:
    """`laglab link echo` in the background: where it answers."""

    def call(*options: str) -> str:
        process = start("link", "echo", "udpin://127.0.0.1:0", *options)
        assert process.stderr is not None
        line = process.stderr.readline()
        assert "waiting for" in line, line
        return line.split("udpin://")[1].split(": ")[0]

    return call


class EnoughError(Exception):
    """An echo has nothing more to do."""


def test_after_a_flood_the_next_is_answered_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ends, "FORGOTTEN", 0.2)
    make_key(tmp_path / "key")
    filler = (0,) * PROBE_FILLER
    over = [threading.Event(), threading.Event()]

    def tell(line: str) -> None:
        if "no longer measured" in line:
            next(each for each in over if not each.is_set()).set()
        if over[1].is_set():
            raise EnoughError

    def answering(link: Endpoint) -> None:
        with (
            Codec(ROBOT_SYSTEM, ROBOT_COMPONENT, tmp_path / "key") as codec,
            contextlib.suppress(EnoughError),
        ):
            answer(Listener(link, codec.receiver), codec, tell)

    with (
        open_endpoint("udpin://127.0.0.1:0") as robot,
        Codec(STATION_SYSTEM, STATION_COMPONENT, tmp_path / "key") as station,
        ThreadPoolExecutor() as pool,
    ):
        echoes = pool.submit(answering, robot)
        for session, ended in enumerate(over):
            with (
                open_endpoint(robot.name.replace("udpin", "udpout")) as prober,
                open_endpoint(robot.name.replace("udpin", "udpout")) as stranger,
            ):
                said = b""
                for _ in range(100):
                    asked = Probe(0, (0,) * 3, 9 * session, 0, 10_000, (NO_PROBE,) * 3, filler)
                    prober.send(station.sender.frame(asked))
                    if said := prober.receive(0.05):
                        break
                assert said, "more than twenty seconds' rations of strangers' are before it"
                assert ended.wait(10)
                for _ in range(300):
                    stranger.send(b"\xfd" * 1400)
        echoes.result(10)


def test_over_udp_frames_have_the_sizes_of_a_run_signed_or_not(
    echoing: Callable[..., str], ended_here: Ended, tmp_path: Path
) -> None:
    make_key(tmp_path / "key")
    for options, sizes in (((), (121, 75)), (("--key", "key"), (147, 101))):
        url = f"udpout://{echoing(*options)}"
        measured = ("--duration", "0.4", "--clocks-within", "0", *options)
        result = ended_here("link", "probe", url, *measured)
        assert result.code == 0, result.err
        assert "one-way" in result.out
        with (tmp_path / "link.csv").open() as file:
            rows = list(csv.DictReader(file))
        for direction, size in zip(("command", "measurement"), sizes, strict=True):
            own = [row for row in rows if row["direction"] == direction]
            assert [int(row["tick"]) for row in own] == list(range(40))
            assert {int(row["size"]) for row in own} == {size}
            assert {row["fate"] for row in own} == {"delivered"}


def test_a_run_s_datagrams_are_as_long(rehearsed: Callable[..., object], tmp_path: Path) -> None:
    rehearsed("lab", "--duration", "10.1", "--no-noise")
    sizes = {
        type(frame.message): len(frame.raw) for _, frame in read_tlog(tmp_path / "run/robot.tlog")
    }
    told = real_sizes(Sender(1, 1))
    assert sizes[Measurement] + sizes[Tick] == told.measurement
    assert sizes[Estimate] + sizes[Command] == told.command


BAD = {
    ("udpin://127.0.0.1:0",): (2, "whoever measures calls"),
    ("udpout://127.0.0.1:9", "--wait", "0.3"): (4, "nobody answers (0.3 s)"),
    ("udpout://127.0.0.1:9", "--out", "no/such/link.csv"): (2, "--out no/such/link.csv"),
    ("serial://nowhere:57600",): (2, "nowhere"),
}


@pytest.mark.parametrize("arguments", BAD)
def test_what_cannot_be_measured_is_one_line(
    arguments: tuple[str, ...], refused: Refused, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    code, said = BAD[arguments]
    assert said in refused("link", "probe", *arguments, code=code)
    assert not (tmp_path / "link.csv").exists()


def test_strangers_are_not_answered_unless_they_may(refused: Refused) -> None:
    assert "say --unsigned" in refused("link", "echo", "udpin://0.0.0.0:0")


def test_a_missing_key_is_named(
    echoing: Callable[..., str], ended_here: Ended, tmp_path: Path
) -> None:
    make_key(tmp_path / "key")
    url = f"udpout://{echoing()}"
    result = ended_here("link", "probe", url, "--key", "key", "--wait", "0.5")
    assert result.code == 4
    assert "the same --key or none" in result.err


@pytest.mark.parametrize(("baud", "interval"), [(57600, 0.04), (115200, 0.025)])
def test_on_a_serial_line_delays_are_its_arithmetic(
    start: Start, ended_here: Ended, tmp_path: Path, baud: int, interval: float
) -> None:
    line = start("serial", "robot", "station", "--baud", str(baud))
    while not (tmp_path / "station").exists():
        time.sleep(0.02)
    start("link", "echo", f"serial://robot:{baud}")
    options = ("--interval", str(interval), "--duration", "1", "--clocks-within", "0")
    result = ended_here("link", "probe", f"serial://station:{baud}", *options, "--wait", "20")
    assert result.code == 0, result.err
    measured = read_measured(tmp_path / "link.csv", interval)
    for _, flow in measured.flows:
        assert flow.lost.mean() < 0.5  # a busy machine pauses within a frame, which ends it
        at_the_rate = flow.size * 10 / baud
        assert at_the_rate * 0.95 < np.nanmin(flow.delay) < at_the_rate + 0.01
    line.send_signal(signal.SIGINT)
    report, _ = line.communicate(timeout=10)
    assert "lost because nobody read them" not in report


def test_a_pty_can_be_measured_too(start: Start, ended_here: Ended, tmp_path: Path) -> None:
    with open_endpoint(f"pty://{tmp_path}/port"):
        pass  # a path that is free again
    start("link", "echo", "pty://port")
    while not (tmp_path / "port").exists():
        time.sleep(0.02)
    measured = ("--duration", "0.3", "--wait", "20")
    result = ended_here("link", "probe", "serial://port:115200", *measured)
    assert result.code == 0, result.err
    assert "half of the shortest round trip" in " ".join(result.out.split())
