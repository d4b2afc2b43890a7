"""The robot in C and our own tools: the conformance kit, and what measures a link."""

import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from laglab_conformance import Mark, Waits, conform
from laglab_protocol import NO_PROBE, PROBE_FILLER, PROBE_LAGS, Message, Probe, Sender, make_key

from .line import PERIOD, Line


@pytest.mark.slow
def test_it_conforms_signed_on_a_line_at_the_pace_of_a_real_one(
    start: Callable[..., Any], firmware: Path, tmp_path: Path
) -> None:
    """Where frames come in pieces; mavgen's parser alone would pass over what follows a false
    start."""
    make_key(tmp_path / "key")
    ports = [tmp_path / "robot", tmp_path / "station"]
    cable = start(sys.executable, "-m", "laglab", "serial", *ports, "--baud", "115200")
    assert "are joined" in cable.stderr.readline()
    start(firmware, "--key", tmp_path / "key", ports[0])
    url, key = f"serial://{ports[1]}:115200", tmp_path / "key"
    report = conform(url, "robot", key, Waits(react=4.0, refuse=0.6), pace="realtime")

    assert report.conforms, report.table()
    tried = {each.name: each.mark for each in report.results if each.group == "signing"}
    assert set(tried.values()) == {Mark.PASSED}


@pytest.mark.slow
def test_the_kits_command_waits_for_it(
    start: Callable[..., Any], firmware: Path, tmp_path: Path
) -> None:
    """As its README says: first the kit, which makes the port, then the robot."""
    url, options = f"pty://{tmp_path}/port", ("--side", "robot", "--pace", "realtime")
    kit = start(sys.executable, "-m", "laglab", "conform", url, *options)
    assert f"testing the robot at {url}" in kit.stderr.readline()
    while not (tmp_path / "port").exists():
        time.sleep(0.01)
    start(firmware, tmp_path / "port")

    told, _ = kit.communicate(timeout=50)
    assert kit.returncode == 0, told
    assert "the robot conforms" in told


def test_the_link_to_it_is_measured_as_its_readme_says(
    start: Callable[..., Any], firmware: Path, tmp_path: Path
) -> None:
    probe = ("link", "probe", f"pty://{tmp_path}/port", "--wait", "30", "--duration", "0.5")
    measuring = start(sys.executable, "-m", "laglab", *probe, "--clocks-within", "0")
    while not (tmp_path / "port").exists():
        time.sleep(0.01)
    start(firmware, tmp_path / "port")
    _, errors = measuring.communicate(timeout=30)
    assert measuring.returncode == 0, errors
    rows = [line.split(",") for line in (tmp_path / "link.csv").read_text().splitlines()[1:]]
    assert [row[1] for row in rows if row[0] == "measurement"] == list(map(str, range(50)))
    late = [float(row[6]) for row in rows if row[0] == "command" and row[5] == "delivered"]
    assert len(late) > 40
    assert max(late) > 0.001, "it reads its port once a tick"


def test_it_answers_whoever_measures_the_link_and_no_longer(line: Line) -> None:
    none, empty = (NO_PROBE,) * 3, (0,) * PROBE_FILLER
    heard: list[Message] = []
    for number in range(300):
        line.say(Probe(1, (0, 0, 0), 77, number, 10_000, none, empty))
        if heard:  # somebody else's, who comes later
            line.say(Probe(1, (0, 0, 0), 5, number, 10_000, none, empty))
        heard += line.hear(PERIOD)
    heard += line.hear(0.1)
    told = [each for each in heard if isinstance(each, Probe)]
    assert len(told) == len(heard) > 200
    assert [each.sequence for each in told] == list(range(len(told)))
    assert {(each.session, each.interval_us) for each in told} == {(77, 10_000)}
    assert {len(Sender(1, 1).frame(each)) for each in told} == {75}
    for place, lag in enumerate(PROBE_LAGS):
        came = [each.came[place] for each in told if each.came[place] != NO_PROBE]
        first = came[0]
        assert came == list(range(first, first + len(came))), "each once, in order"
        assert len(came) > 200 - lag
    assert abs(told[0].came_ns[0] - time.time_ns()) < 60e9
    line.hear(1.0)  # its second without a probe is over by now
    assert line.hear(0.2) == []
