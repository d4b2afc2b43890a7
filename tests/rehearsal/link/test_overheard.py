"""What was overheard at the robot, as link.csv: telemetry logs and captures."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import dpkt
import numpy as np
import pytest

from laglab.link.importing import How, read_link
from laglab.link.measured import MeasuredLink
from laglab.link.probing import Sizes
from laglab_protocol import Command, Measurement, Message, Sender, Tick, tlog_record

HOW = How(Sizes(121, 75))

SAID: Sequence[tuple[float, int, tuple[Message, ...]]] = [
    (0.000, 1, (Measurement(0.0, 0.0, 0.0, 0.0, 0.0, 0, -1), Tick(0, 1))),
    (0.008, 200, (Command(0.0, 0.0, 0, 1, 1, 0),)),
    (0.010, 1, (Tick(1, 0),)),
    (0.020, 1, (Tick(2, 0),)),
    (0.025, 200, (Command(0.0, 0.0, 1, 1, 1, 0),)),
    (0.030, 1, (Tick(3, 0),)),
    (0.034, 200, (Command(0.0, 0.0, 3, 1, 1, 0),)),
    (0.040, 1, (Tick(4, 0),)),
]
"""What is overheard at the robot: when [s], who says it, in one datagram; tick 2 is not answered,
and after tick 3 the station is gone."""


def checked(measured: MeasuredLink) -> None:
    np.testing.assert_allclose(measured.command.delay, [0.004, 0.0075, np.nan, 0.002], atol=1e-7)
    np.testing.assert_allclose(measured.command.sent, [0.0, 0.01, 0.02, 0.03], atol=1e-7)
    assert measured.interval == pytest.approx(0.01)
    assert "the station's thinking included" in measured.notes[0]


def test_a_telemetry_log_tells_how_long_answers_took(tmp_path: Path) -> None:
    senders = {number: Sender(number, 1) for number in (1, 200)}
    records = (
        tlog_record(round(1.7e15 + 1e6 * time), senders[who].frame(message))
        for time, who, said in SAID
        for message in said
    )
    (tmp_path / "logged").write_bytes(b"".join(records))
    checked(read_link(tmp_path / "logged", HOW))


@pytest.mark.parametrize("kind", ["pcap", "pcapng"])
def test_a_capture_tells_it_too(tmp_path: Path, kind: str) -> None:
    senders = {number: Sender(number, 1) for number in (1, 200)}
    writer = dpkt.pcap.Writer if kind == "pcap" else dpkt.pcapng.Writer
    with (tmp_path / "captured").open("wb") as file:
        capture = writer(file)
        for time, who, said in SAID:
            payload = b"".join(map(senders[who].frame, said))
            udp = dpkt.udp.UDP(sport=1, dport=2, ulen=8 + len(payload), data=payload)
            ip = dpkt.ip.IP(src=b"\n\0\0\1", dst=b"\n\0\0\2", p=17, len=28 + len(payload), data=udp)
            capture.writepkt(bytes(dpkt.ethernet.Ethernet(data=ip)), ts=1.7e9 + time)
        capture.writepkt(b"noise", ts=1.7e9)
    checked(read_link(tmp_path / "captured", HOW))


def test_the_log_of_a_run_is_known_by_ticks(rehearsed: Callable[..., Any], tmp_path: Path) -> None:
    rehearsed("fig6", "--duration", "0.5")
    measured = read_link(tmp_path / "run" / "robot.tlog", HOW)
    assert len(measured.command.delay) == 51
    assert not measured.command.delay.any(), "a station that is asked inline answers at once"
    assert "whole ticks" in measured.notes[-1]
