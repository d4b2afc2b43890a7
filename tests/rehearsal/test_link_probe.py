"""A link is measured: by the cores in a world of numbers, by processes on real links."""

import contextlib
import csv
import heapq
import signal
import subprocess
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from laglab.command import main
from laglab.link.measured import bursts, read_measured
from laglab.link.probing import Clocks, Prober, Sizes, ends, real_sizes, seen_by_clocks
from laglab.link.probing import echo as answer
from laglab.link.probing.clocks import ClockTimes, lowest_line
from laglab.link.probing.ends import Echo
from laglab.link.probing.probe import hidden_arrivals
from laglab.link.probing.sizes import overload
from laglab_protocol import (
    NO_PROBE,
    PROBE_FILLER,
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_SYSTEM,
    Codec,
    Endpoint,
    Listener,
    Probe,
    Sender,
    make_key,
    open_endpoint,
)

Laglab = Callable[..., subprocess.CompletedProcess[str]]
Start = Callable[..., "subprocess.Popen[str]"]
FILLER = (1,) * 7 + (0,) * (PROBE_FILLER - 7)
INTERVAL_US = 10_000
AHEAD_NS = 1_700_000_000_000_000_000
"""By which the robot's clock is ahead of the station's."""


def crossed(
    count: int, up: Callable[[int], int | None], down: Callable[[int], int | None]
) -> Clocks:
    """The two ends in a world without time: frame number i takes up(i), down(i) ns, None: lost."""
    prober, echo = Prober(7, count, INTERVAL_US, FILLER), Echo(FILLER)
    flying: list[tuple[int, int, bool, Probe]] = []
    now, due = 0, 0
    while not prober.is_done(now):
        if now >= due:
            said = prober.say(now)
            due += INTERVAL_US * 1000
            if (took := up(said.sequence)) is not None:
                heapq.heappush(flying, (now + took, said.sequence, True, said))
        while flying and flying[0][0] <= now:
            came, _, upwards, said = heapq.heappop(flying)
            if upwards:
                echo.hear(said, came + AHEAD_NS)
            else:
                prober.hear(said, came)
        while (answer := echo.say(now + AHEAD_NS)) is not None:
            if (took := down(answer.sequence)) is not None:
                heapq.heappush(flying, (now + took, answer.sequence, False, answer))
        now += 500_000
    return seen_by_clocks(*prober.times(), None)


def test_every_frame_is_accounted_for_though_some_are_lost_each_way() -> None:
    rng = np.random.default_rng(5)
    lost = rng.random((2, 4000)) < 0.05
    lost[1, 100:130] = True  # a gap in what is told
    late = rng.integers(0, 20, (2, 4000)) * 500_000
    late[:, 7::50] = 0
    seen = crossed(
        600,
        lambda i: None if lost[0, i] else 12_000_000 + int(late[0, i]),
        lambda i: None if lost[1, i] else 8_000_000 + int(late[1, i]),
    )
    for name, delays, gone, took in (
        ("up", seen.ours, lost[0, :600], late[0, :600]),
        ("down", seen.theirs, lost[1, :600], late[1, :600]),
    ):
        np.testing.assert_array_equal(np.isnan(delays), gone, name)
        # Half of the shortest round trip stands for the fastest frame each way.
        np.testing.assert_allclose(delays[~gone], 0.010 + 1e-9 * took[~gone], atol=6e-4)
    assert "20 ms" in seen.note
    assert "not known to agree" in seen.note


def test_a_link_that_dies_ends_the_measurement() -> None:
    seen = crossed(300, lambda i: 1_000_000 if i < 200 else None, lambda _: 1_000_000)
    assert np.isnan(seen.ours).nonzero()[0].tolist() == list(range(200, 300))


def test_clocks_that_drift_are_taken_apart() -> None:
    rng = np.random.default_rng(2)
    sent = 0.01 * np.arange(6000.0)
    jitter = rng.exponential(0.004, (2, 6000))
    ahead = -3.0 + 80e-6 * sent  # the second clock gains 5 ms in a minute
    seen = seen_by_clocks(
        ClockTimes(sent, 0.02 + jitter[0] + ahead), ClockTimes(sent, 0.02 + jitter[1] - ahead), None
    )
    np.testing.assert_allclose(seen.ours, 0.02 + jitter[0], atol=1e-4)
    np.testing.assert_allclose(seen.theirs, 0.02 + jitter[1], atol=1e-4)


def test_clocks_that_agree_give_one_way_delays_and_those_that_do_not_are_found_out() -> None:
    there = ClockTimes(np.array([0.0, 0.01]), np.array([0.003, np.nan]))
    back = ClockTimes(np.array([0.0, 0.01]), np.array([0.009, 0.011]))
    seen = seen_by_clocks(there, back, 0.001)
    np.testing.assert_array_equal(seen.ours, [0.003, np.nan])
    np.testing.assert_array_equal(seen.theirs, [0.009, 0.011])
    assert "one-way" in seen.note
    off = ClockTimes(there.sent, there.apart - 0.005)
    found = seen_by_clocks(off, back, 0.001)
    assert "a frame came 2 ms before it was sent" in found.note
    np.testing.assert_allclose(found.ours[0], 0.0035)


def test_what_nothing_came_of_has_no_delay() -> None:
    nothing, back = (ClockTimes.of([0, 10], [None, None]), ClockTimes.of([0, 10], [5, 20]))
    assert lowest_line(nothing) is None
    assert np.isnan(seen_by_clocks(nothing, back, None).theirs).all()


def test_bursts_are_counted() -> None:
    assert bursts(np.array([True, False, True, True, False])) == [1, 2]
    assert bursts(np.array([False])) == []


def test_an_end_that_hears_nothing_tells_of_nothing_and_is_forgotten() -> None:
    echo = Echo(FILLER)
    assert echo.say(0) is None
    assert echo.hear(Probe(0, (0, 0, 0), 1, 5, 10, (NO_PROBE,) * 3, FILLER), 0)
    assert echo.end is not None
    assert echo.end.interval_us == 1000, "no more than a thousand a second"
    said = echo.say(0)
    assert said is not None
    assert said.came == (5, NO_PROBE, NO_PROBE)
    assert echo.take_over(10**9 - 1) is None
    assert echo.take_over(10**9) is not None
    assert echo.say(10**10) is None


def test_who_measures_slowly_is_not_forgotten_in_between() -> None:
    echo = Echo(FILLER)
    slow = Probe(0, (0, 0, 0), 1, 5, 2_000_000, (NO_PROBE,) * 3, FILLER)
    echo.hear(slow, 0)
    assert echo.take_over(6 * 10**9 - 1) is None
    assert echo.take_over(6 * 10**9) is not None
    echo.hear(Probe(0, (0, 0, 0), 1, 5, 2**32 - 1, (NO_PROBE,) * 3, FILLER), 0)
    assert echo.take_over(30 * 10**9) is not None, "nobody keeps it for an hour"


def test_somebody_is_asked_twice_however_long_the_interval(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with open_endpoint("udpin://127.0.0.1:0") as silent:
        url = silent.name.replace("udpin", "udpout")
        code, line = refused(capsys, "probe", url, "--wait", "0.1", "--interval", "0.2")
        assert [bool(silent.receive(0.0)) for _ in range(3)] == [True, True, False]
    assert code == 4
    assert "nobody answers (0.4 s)" in line
    assert "it answers one `laglab link probe` at a time" in line


def test_a_line_that_carries_less_than_a_run_says_is_told() -> None:
    sizes = Sizes(121, 75)
    said = overload("serial:///dev/ttyUSB0:57600", sizes, 0.01)
    assert said is not None
    assert "57600 baud carry less than the 121000" in said
    for url in ("serial:///dev/ttyUSB0:230400", "/dev/ttyUSB0,230400", "udpout://1.2.3.4:9"):
        assert overload(url, sizes, 0.01) is None
    assert overload("/dev/ttyUSB0,57600", sizes, 0.01) is not None


def test_who_measures_is_not_disturbed_by_another() -> None:
    echo = Echo(FILLER)

    def asked(session: int) -> Probe:
        return Probe(0, (0, 0, 0), session, 0, INTERVAL_US, (NO_PROBE,) * 3, FILLER)

    last = 2**32 - 1
    assert echo.is_for(asked(last), 0)
    echo.hear(asked(last), 0)
    assert echo.is_for(asked(last), 1)
    assert echo.is_for(asked(0), 1), "the next one is the same measurer's"
    assert not echo.is_for(asked(1), 1)
    assert echo.is_for(asked(1), 10**9)


def test_arrivals_of_which_nothing_tells_are_estimated() -> None:
    rng = np.random.default_rng(1)
    lost = rng.random((2, 9000)) < 0.3
    seen = crossed(
        2000,
        lambda i: None if lost[0, i] else 10_000_000,
        lambda i: None if lost[1, i] else 10_000_000,
    )
    hidden = int(np.isnan(seen.ours).sum() - lost[0, :2000].sum())
    assert hidden > 10
    assert hidden_arrivals(seen) == pytest.approx(hidden, rel=0.5)
    assert hidden_arrivals(Clocks(np.zeros(9), np.zeros(9), "")) == 0


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
                    asked = Probe(0, (0,) * 3, 9 * session, 0, 10_000, (NO_PROBE,) * 3, FILLER)
                    prober.send(station.sender.frame(asked))
                    if said := prober.receive(0.05):
                        break
                assert said, "more than twenty seconds' rations of strangers' are before it"
                assert ended.wait(10)
                for _ in range(300):
                    stranger.send(b"\xfd" * 1400)
        echoes.result(10)


def test_over_udp_frames_have_the_sizes_of_a_run_signed_or_not(
    echoing: Callable[..., str], laglab: Laglab, tmp_path: Path
) -> None:
    make_key(tmp_path / "key")
    for options, sizes in (((), (121, 75)), (("--key", "key"), (147, 101))):
        url = f"udpout://{echoing(*options)}"
        measured = ("--duration", "0.4", "--clocks-within", "0", *options)
        result = laglab("link", "probe", url, *measured)
        assert result.returncode == 0, result.stderr
        assert "one-way" in result.stdout
        with (tmp_path / "link.csv").open() as file:
            rows = list(csv.DictReader(file))
        for direction, size in zip(("command", "measurement"), sizes, strict=True):
            own = [row for row in rows if row["direction"] == direction]
            assert [int(row["tick"]) for row in own] == list(range(40))
            assert {int(row["size"]) for row in own} == {size}
            assert {row["fate"] for row in own} == {"delivered"}


def test_a_run_s_datagrams_are_as_long(rehearsed: Callable[..., object], tmp_path: Path) -> None:
    from laglab_protocol import Command, Estimate, Measurement, Tick, read_tlog

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


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[object, str]:
    """The exit code, and the one line that says why."""
    with pytest.raises(SystemExit) as ended:
        main(["link", *arguments])
    (line,) = capsys.readouterr().err.splitlines()
    return ended.value.code, line


@pytest.mark.parametrize("arguments", BAD)
def test_what_cannot_be_measured_is_one_line(
    arguments: tuple[str, ...],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    code, line = refused(capsys, "probe", *arguments)
    assert code == BAD[arguments][0]
    assert BAD[arguments][1] in line
    assert not (tmp_path / "link.csv").exists()


def test_strangers_are_not_answered_unless_they_may(capsys: pytest.CaptureFixture[str]) -> None:
    code, line = refused(capsys, "echo", "udpin://0.0.0.0:0")
    assert code == 2
    assert "say --unsigned" in line


def test_a_missing_key_is_named(
    echoing: Callable[..., str], laglab: Laglab, tmp_path: Path
) -> None:
    make_key(tmp_path / "key")
    url = f"udpout://{echoing()}"
    result = laglab("link", "probe", url, "--key", "key", "--wait", "0.5")
    assert result.returncode == 4
    assert "the same --key or none" in result.stderr


@pytest.mark.parametrize(("baud", "interval"), [(57600, 0.04), (115200, 0.025)])
def test_on_a_serial_line_delays_are_its_arithmetic(
    start: Start, laglab: Laglab, tmp_path: Path, baud: int, interval: float
) -> None:
    line = start("serial", "robot", "station", "--baud", str(baud))
    while not (tmp_path / "station").exists():
        time.sleep(0.02)
    start("link", "echo", f"serial://robot:{baud}")
    options = ("--interval", str(interval), "--duration", "1", "--clocks-within", "0")
    result = laglab("link", "probe", f"serial://station:{baud}", *options, "--wait", "20")
    assert result.returncode == 0, result.stderr
    measured = read_measured(tmp_path / "link.csv", interval)
    for _, flow in measured.flows:
        assert flow.lost.sum() <= 1  # a busy machine pauses within a frame, which ends it
        at_the_rate = flow.size * 10 / baud
        assert at_the_rate * 0.95 < np.median(flow.delay) < at_the_rate + 0.01
    line.send_signal(signal.SIGINT)
    report, _ = line.communicate(timeout=10)
    assert "lost because nobody read them" not in report


def test_a_pty_can_be_measured_too(start: Start, laglab: Laglab, tmp_path: Path) -> None:
    with open_endpoint(f"pty://{tmp_path}/port"):
        pass  # a path that is free again
    start("link", "echo", "pty://port")
    while not (tmp_path / "port").exists():
        time.sleep(0.02)
    result = laglab("link", "probe", "serial://port:115200", "--duration", "0.3", "--wait", "20")
    assert result.returncode == 0, result.stderr
    assert "half of the shortest round trip" in " ".join(result.stdout.split())
