"""What the loop tells its live page, in datagrams."""

import asyncio
import socket

import msgspec
import pytest

from laglab.live import feed
from laglab.live.feed import Controls, Feed
from laglab.live.messages import Given, Line, LiveOrder, Rows, packed, unpacked
from laglab.live.page import FOR_EVER, announced, page_html
from laglab.live.server import _unless_crowded
from laglab.live.stream import Known
from laglab.results.report.tables import ALARM, STOPPED
from laglab.scenario import load
from laglab_gateway import FOLLOWED, ArrivalRow, TraceRow
from laglab_gateway.side import EMERGENCY_STOP
from laglab_station import ESTIMATE_IS_WRONG


def test_a_fast_station_s_frames_all_have_room() -> None:
    """They come in more than one datagram of 60,000 bytes; without one of them the page would have
    a gap, without all of them nothing."""
    frames = [number.to_bytes(2) * 100 for number in range(900)]
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as page:
        page.bind(("127.0.0.1", 0))
        page.settimeout(5.0)
        loop = Feed(Line(page.getsockname()[1], "secret"), Controls(lambda: None, lambda: False))
        loop.said(frames)
        loop.flush()
        came: list[bytes] = []
        while len(came) < len(frames):
            rows = unpacked(page.recv(1 << 16), "secret")
            assert isinstance(rows, Rows)
            came += rows.frames
        loop.close()
    assert came == frames


def test_of_many_ticks_both_directions_are_told_and_all_that_was_refused() -> None:
    """Each tick brings one of each, in turn."""
    arrivals = [
        ArrivalRow(
            direction, k, k, 0.01 * k, "stale" if direction == "command" and not k % 9 else FOLLOWED
        )
        for k in range(150)
        for direction in ("measurement", "command")
    ]
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as page:
        page.bind(("127.0.0.1", 0))
        page.settimeout(5.0)
        loop = Feed(Line(page.getsockname()[1], "secret"), Controls(lambda: None, lambda: False))
        for k in range(150):
            loop.row(TraceRow(k, 0.01 * k, *(None,) * 13))
        loop.arrivals(arrivals)
        loop.flush()
        rows = unpacked(page.recv(1 << 16), "secret")
        loop.close()
    assert isinstance(rows, Rows)
    told = [each.arrived for each in rows.arrivals if each.direction == "measurement"]
    followed = {each.arrived for each in rows.arrivals if each.direction == "command"}
    assert told == [each.tick for each in rows.trace]
    assert followed >= set(told)
    assert [each for each in rows.arrivals if each.refused != FOLLOWED] == [
        each for each in arrivals if each.refused != FOLLOWED
    ]


def test_a_run_that_is_ended_from_the_page_is_ended_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """The page says so until the loop is gone, which has to take its leave of its station."""
    monkeypatch.setattr(feed, "PERIOD", 0.0)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as page:
        page.bind(("127.0.0.1", 0))
        page.settimeout(5.0)
        loop = Feed(Line(page.getsockname()[1], "secret"), Controls(lambda: None, lambda: False))
        ended = 0
        for _ in range(5):
            try:
                loop.flush()
            except KeyboardInterrupt:
                ended += 1
            _, there = page.recvfrom(1 << 16)
            page.sendto(packed(Given("end"), "secret"), there)
        loop.close()
    assert ended == 1


def test_a_crowd_at_the_door_is_not_told_to_the_terminal(
    capsys: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    """But a fault of ours is."""
    loop = asyncio.new_event_loop()
    try:
        loop.set_exception_handler(_unless_crowded)
        loop.call_exception_handler({"message": "accept", "exception": OSError(24, "too many")})
        assert not caplog.records
        loop.call_exception_handler({"message": "ours", "exception": ValueError("ours")})
        assert len(caplog.records) == 1
    finally:
        loop.close()
    assert capsys.readouterr().err == ""


def test_of_a_real_robot_the_page_knows_no_true_pose_and_no_deadlines() -> None:
    scenario = load("lab", {"pace": "realtime"})
    order = LiveOrder(scenario.to_toml(), "127.0.0.1", 0, "t", "s", False, False, "simulated")
    real = msgspec.structs.replace(order, measured=True)
    ours, theirs = (page_html(scenario, each, controls=False) for each in (order, real))
    assert "estimate less robot" in ours
    assert "estimate less measurement" in theirs
    assert "ticks began late by" in ours
    assert "ticks began late by" not in theirs


def test_outages_that_are_announced_are_hatched_as_in_the_report() -> None:
    for name, hatched in (("lab-radio", True), ("lab", False)):
        scenario = load(name)
        order = LiveOrder(scenario.to_toml(), "127.0.0.1", 0, "t", "s", False, False, "simulated")
        assert ('"hatch_pattern":' in page_html(scenario, order, controls=False)) == hatched
    endless = load(
        "lab", {"duration": float("inf"), "link.event": [{"at": 2.0, "link": {"loss": 1.0}}]}
    )
    assert announced(endless) == [(2.0, FOR_EVER)]
    assert announced(load("lab-radio", {"duration": 2.0})) == [], "the run is over by then"


def test_of_what_the_sides_say_stops_and_alarms_are_marked() -> None:
    said = [EMERGENCY_STOP, f"{ESTIMATE_IS_WRONG} at tick 3: locating", "lost the watcher at a:1"]
    piece = Known().learn(Rows(), said, load("lab"))
    assert piece.tables["marks"]["lane"] == [STOPPED, ALARM]
    assert [text.split(": ", 1)[1] for text in piece.texts] == said
