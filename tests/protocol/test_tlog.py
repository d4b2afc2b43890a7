"""The log reads back, by us and by mavlogdump.py."""

import subprocess
import sys
from pathlib import Path

import pytest

from laglab_protocol import Command, Sender, Tick, TlogError, read_tlog, tlog_record
from laglab_protocol.tlog import PIECE

T0 = 1_700_000_000_000_000


@pytest.fixture
def log(tmp_path: Path) -> Path:
    robot, station = Sender(1, 1), Sender(200, 190)
    records = [
        tlog_record(T0, robot.frame(Tick(7, 0))),
        tlog_record(T0 + 10_000, station.frame(Command(0.25, -1.5, 7, 1, 1, 0))),
    ]
    path = tmp_path / "robot.tlog"
    path.write_bytes(b"".join(records))
    return path


def test_the_log_reads_back(log: Path) -> None:
    read = [(time_us, frame.message, frame.system) for time_us, frame in read_tlog(log)]

    assert read == [(T0, Tick(7, 0), 1), (T0 + 10_000, Command(0.25, -1.5, 7, 1, 1, 0), 200)]


@pytest.mark.parametrize("cut", [1, 5, 12, 30])
def test_a_log_cut_short_is_whole_up_to_there(log: Path, cut: int) -> None:
    log.write_bytes(log.read_bytes()[:-cut])

    assert [frame.message for _, frame in read_tlog(log)] == [Tick(7, 0)]


def test_what_is_no_log_is_refused(tmp_path: Path) -> None:
    other = tmp_path / "other.tlog"
    other.write_bytes(b"this is some text, not a log")

    with pytest.raises(TlogError, match="byte 8"):
        list(read_tlog(other))


@pytest.mark.parametrize("ahead", [*range(0, 240, 20), 300])
def test_what_the_dialect_does_not_have_is_left_out_wherever_it_stands(
    log: Path, ahead: int
) -> None:
    """On the border of what is read at once, too, and cut short at the end."""
    unknown = tlog_record(T0, b"\xfd" + bytes([220, 0, 0, 0, 1, 1]) + b"\x33\x33\x33" + bytes(222))
    record = tlog_record(T0, Sender(1, 1).frame(Tick(1, 0)))
    before, rest = divmod(PIECE - ahead, len(record))
    filling = tlog_record(T0, b"\xfd" + bytes([rest, 0, 0, 0, 1, 1, 51, 51, 51]) + bytes(rest + 2))
    log.write_bytes(record * (before - 1) + filling + unknown + log.read_bytes() + unknown[:-9])
    assert [frame.message for _, frame in read_tlog(log)][before - 1 :] == [
        Tick(7, 0),
        Command(0.25, -1.5, 7, 1, 1, 0),
    ]


def test_mavlogdump_reads_it(log: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "laglab_protocol.pymavlink", "mavlogdump", log],
        capture_output=True,
        text=True,
        check=True,
        timeout=30,
    )

    assert "LAGLAB_TICK {tick : 7, measurements : 0}" in done.stdout
    assert "LAGLAB_COMMAND {v : 0.25, omega : -1.5, tick : 7" in done.stdout


@pytest.mark.parametrize("program", ["nothing", "nothing.py", "nothing.more"])
def test_a_program_that_there_is_not_is_one_line(program: str) -> None:
    command = [sys.executable, "-m", "laglab_protocol.pymavlink", program]
    told = subprocess.run(command, capture_output=True, text=True, check=False)
    assert told.returncode == 1
    assert told.stderr.startswith(f"{program}: no ")
    assert len(told.stderr.splitlines()) == 1
