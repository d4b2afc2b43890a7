"""What ping printed, as link.csv."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from .measured import imported
from .printed import BUSYBOX, LINUX, MACOS, WINDOWS, pings

Refused = Callable[..., str]


@pytest.mark.parametrize(
    ("printed", "interval"), [(LINUX, 0.2), (MACOS, 1.0), (BUSYBOX, 1.0), (WINDOWS, 1.0)]
)
def test_ping_is_halved(tmp_path: Path, printed: str, interval: float) -> None:
    measured = imported(tmp_path, printed)
    np.testing.assert_allclose(measured.command.delay, [0.005, 0.007, np.nan, 0.006, np.nan])
    np.testing.assert_allclose(measured.measurement.delay, [0.005, 0.007, 0.007, 0.006, 0.006])
    assert measured.interval == pytest.approx(interval, abs=0.01)
    assert "half of a round trip" in measured.notes[0]
    assert "counts as a lost command" in measured.notes[1]
    assert (measured.command.size, measured.measurement.size) == (121, 75)


def test_a_long_ping_s_numbers_go_on_where_they_wrap(tmp_path: Path) -> None:
    lines = (f"64 bytes from x: icmp_seq={k % 65536} ttl=5 time=1 ms" for k in range(1, 70_000, 2))
    assert len(imported(tmp_path, "\n".join(lines)).command.delay) == 69_999


@pytest.mark.parametrize(
    ("printed", "lost"),
    [
        (pings(40_000, 40_001, 40_003), [2]),
        (pings(65_534, 65_535, 65_537, 65_538), [2]),
        ("PING x\n" + pings(65_535, 65_536), []),
        (pings(40_000, 40_001) + "40001 packets transmitted, 2 received, time 40000ms\n", []),
        ("PING x\n" + pings(3, 4) + "5 packets transmitted, 2 received, time 4000ms\n", [0, 1, 4]),
        ("PING x\nRequest timeout for icmp_seq 0\n" + pings(1, 2), [0]),
        (pings(1) + "no answer yet for icmp_seq=2\n", [1]),
    ],
)
def test_a_ping_may_begin_at_any_number(tmp_path: Path, printed: str, lost: list[int]) -> None:
    command = imported(tmp_path, printed).command
    assert np.flatnonzero(command.lost).tolist() == lost
    assert len(command.delivered) == printed.count("time=1 ms")


def timed(*numbers: int) -> str:
    """As `ping -D -i 0.1` prints them."""
    lines = zip(numbers, pings(*numbers).splitlines(keepends=True), strict=True)
    return "".join(f"[{1_700_000_000 + k / 10:.6f}] {line}" for k, line in lines)


@pytest.mark.parametrize(
    ("printed", "count"),
    [
        (pings(1, 60_000), 60_000),
        ("PING x\n" + pings(1, 65_000), 65_000),
        (pings(30_000, 65_530, 65_540), 35_541),
        (pings(65_537, 65_534, 65_538), 5),
        (timed(1, 2, 60_000, 60_001), 60_001),
        (timed(20_000, 20_001, 70_000), 50_001),
        (timed(1, 2, 65_530, 65_529), 65_530),
        (timed(1, 2, 140_000, 140_001), 140_001),
        (timed(65_530, 65_531, 65_537, 65_535), 8),
    ],
)
def test_after_an_outage_of_any_length_the_numbers_go_on(
    tmp_path: Path, printed: str, count: int
) -> None:
    measured = imported(tmp_path, printed)
    assert len(measured.command.delay) == count
    assert len(measured.command.delivered) == printed.count("time=1 ms")
    assert measured.interval == pytest.approx(0.1 if "[" in printed else 1.0, rel=1e-5)


def test_the_interval_is_that_of_pings_not_of_answers(tmp_path: Path) -> None:
    assert imported(tmp_path, timed(1, 4, 6, 9)).interval == pytest.approx(0.1, rel=1e-5)


@pytest.mark.parametrize(
    "printed",
    [
        LINUX + LINUX,
        MACOS + "\n" + LINUX,
        BUSYBOX * 3,
        LINUX.partition("\n")[2] + pings(1, 2),
        "PING x\n" + pings(1, 2) + "PING x\n" + pings(3),
        "PING6(56=40+8+8 bytes) ::1 --> ::1\n" + pings(0, 1) + LINUX,
    ],
)
def test_two_outputs_of_ping_are_not_taken_for_one(
    tmp_path: Path, printed: str, refused: Refused
) -> None:
    (tmp_path / "ping.txt").write_text(printed)
    line = refused("link", "import", tmp_path / "ping.txt")
    assert "outputs of ping in one file: give one at a time" in line


def test_who_was_asleep_goes_on_with_the_next_number(tmp_path: Path) -> None:
    asleep = timed(70_000).replace("icmp_seq=4464", "icmp_seq=3")
    assert len(imported(tmp_path, timed(1, 2) + asleep).command.delay) == 3


def test_two_pings_on_windows_are_one_after_the_other(tmp_path: Path) -> None:
    """No number tells them apart, nor merges them."""
    assert len(imported(tmp_path, WINDOWS + WINDOWS).command.delay) == 10


def test_numbers_that_go_back_where_no_time_tells_are_refused(
    tmp_path: Path, refused: Refused
) -> None:
    (tmp_path / "ping.txt").write_text(pings(20_000, 20_001, 9))
    assert "20001 is followed by 9" in refused("link", "import", tmp_path / "ping.txt")


def test_a_long_line_costs_no_more_than_it_is_long(tmp_path: Path) -> None:
    # By an expression that goes back at each of them this would take a quarter of an hour.
    lines = "seq=1 " * 100_000 + "\n" + "time=3 seq=1 " * 100_000 + "\n"
    assert len(imported(tmp_path, lines + pings(1, 2)).command.delay) == 2
