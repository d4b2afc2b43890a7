"""UDP endpoints over real sockets."""

import threading
import time
from contextlib import ExitStack

import pytest

from laglab_protocol import Endpoint, NoSuchPortError, open_endpoint
from laglab_protocol.endpoints.udp import STRANGERS_A_SECOND, STRANGERS_DATAGRAM

WAIT = 2.0


def udp_pair(stack: ExitStack) -> tuple[Endpoint, Endpoint]:
    robot = stack.enter_context(open_endpoint("udpin://127.0.0.1:0"))
    station = stack.enter_context(open_endpoint(robot.name.replace("udpin", "udpout")))
    return robot, station


def test_udp_both_ways(stack: ExitStack) -> None:
    robot, station = udp_pair(stack)
    station.send(b"hello")
    assert robot.receive(WAIT) == b"hello"
    robot.accept_peer()
    robot.send(b"welcome")

    assert station.receive(WAIT) == b"welcome"
    assert robot.datagrams
    assert robot.loopback


def test_what_may_not_be_reached_is_no_matter_of_ports() -> None:
    with pytest.raises(NoSuchPortError, match="check host and port"):
        open_endpoint("udpout://255.255.255.255:14550")


def test_udpin_without_a_peer_drops(stack: ExitStack) -> None:
    robot, station = udp_pair(stack)
    robot.send(b"to nobody")
    station.send(b"not accepted")
    robot.receive(WAIT)
    robot.send(b"to nobody")

    assert station.receive(0.02) == b""


def test_a_stranger_does_not_take_the_link(stack: ExitStack) -> None:
    robot, station = udp_pair(stack)
    stranger = stack.enter_context(open_endpoint(station.name))
    station.send(b"mine")
    robot.receive(WAIT)
    robot.accept_peer()
    stranger.send(b"garbage")
    robot.receive(WAIT)
    robot.send(b"answer")

    assert station.receive(WAIT) == b"answer"
    assert stranger.receive(0.02) == b""


def test_what_came_before_the_peer_was_accepted_is_there_at_once(stack: ExitStack) -> None:
    robot, station = udp_pair(stack)
    for number in range(20):
        station.send(b"%d" % number)
    robot.receive(WAIT)
    robot.accept_peer()
    assert [robot.receive(0.0) for _ in range(20)] == [*(b"%d" % k for k in range(1, 20)), b""]


def test_what_came_before_the_peer_was_accepted_comes_before_what_it_sends_then(
    stack: ExitStack,
) -> None:
    robot, station = udp_pair(stack)
    stranger = stack.enter_context(open_endpoint(station.name))
    for number in range(4):
        station.send(b"%d" % number)
        stranger.send(b"strange")
    robot.receive(WAIT)
    robot.accept_peer()
    station.send(b"4")
    heard = [robot.receive(0.02) for _ in range(9)]
    assert [each for each in heard if each != b"strange"] == [b"1", b"2", b"3", b"4", b""]


def test_a_later_accepted_peer_replaces_the_first(stack: ExitStack) -> None:
    robot, station = udp_pair(stack)
    again = stack.enter_context(open_endpoint(station.name))
    for peer in (station, again):
        peer.send(b"hello")
        robot.receive(WAIT)
        robot.accept_peer()
    robot.send(b"answer")

    assert again.receive(WAIT) == b"answer"
    assert station.receive(0.02) == b""


def test_beside_a_peer_strangers_are_rationed(stack: ExitStack) -> None:
    robot, station = udp_pair(stack)
    station.send(b"hello")
    robot.receive(WAIT)
    robot.accept_peer()
    stranger = stack.enter_context(open_endpoint(station.name))
    for _ in range(20):
        stranger.send(bytes(1400))
    began = time.monotonic()
    heard = len(robot.receive(0.01))
    while time.monotonic() < began + 0.3:
        heard += len(robot.receive(0.01))
    seconds = time.monotonic() - began
    assert 0 < heard < STRANGERS_DATAGRAM + 1400 + STRANGERS_A_SECOND * (seconds + 0.1)


def test_beside_a_peer_that_was_left_nobody_is_a_stranger(stack: ExitStack) -> None:
    robot, station = udp_pair(stack)
    others = [stack.enter_context(open_endpoint(station.name)) for _ in range(2)]
    station.send(b"hello")
    robot.receive(WAIT)
    robot.accept_peer()
    robot.leave_peer()
    robot.send(b"to nobody")
    for _ in range(20):
        others[0].send(bytes(1400))  # strangers' ration of three seconds
    others[1].send(b"now me")
    heard = [robot.receive(WAIT) for _ in range(21)]
    assert heard[-1] == b"now me"
    robot.accept_peer()
    robot.send(b"answer")
    assert others[1].receive(WAIT) == b"answer"
    assert station.receive(0.02) == b""


def test_udpout_before_anybody_listens(stack: ExitStack) -> None:
    with open_endpoint("udpin:127.0.0.1:0") as taken:
        name = taken.name
    station = stack.enter_context(open_endpoint(name.replace("udpin", "udpout")))
    started = time.monotonic()
    for _ in range(3):
        station.send(b"anybody?")
        assert station.receive(0.1) == b""
    assert time.monotonic() - started >= 0.25

    robot = stack.enter_context(open_endpoint(name))
    station.send(b"now?")
    assert robot.receive(WAIT) == b"now?"


@pytest.mark.parametrize("timeout", [0.0, 0.01, 0.2])
def test_udp_waits_as_long_as_told(stack: ExitStack, timeout: float) -> None:
    robot, station = udp_pair(stack)
    for endpoint in (robot, station):
        took = []
        for _ in range(3):  # we may be held up once
            started = time.monotonic()
            assert endpoint.receive(timeout) == b""
            took.append(time.monotonic() - started)
        assert timeout <= min(took) + 0.001 < timeout + 0.5


def test_udpin_binds_loopback_unless_told_otherwise(stack: ExitStack) -> None:
    assert stack.enter_context(open_endpoint("udpin://:0")).name.startswith("udpin://127.0.0.1:")
    assert not stack.enter_context(open_endpoint("udpin://0.0.0.0:0")).loopback


def test_an_empty_datagram_is_nothing(stack: ExitStack) -> None:
    robot, station = udp_pair(stack)
    station.send(b"")

    assert robot.receive(WAIT) == b""


def test_a_refusal_that_comes_late_does_not_keep_the_processor_busy(stack: ExitStack) -> None:
    """Over a network it comes after the first wait; the descriptor wakes, and there is nothing."""
    with open_endpoint("udpin://:0") as nobody:
        url = nobody.name.replace("udpin", "udpout")
    station = stack.enter_context(open_endpoint(url))
    later = threading.Timer(0.02, station.send, [b"x"])
    later.start()
    busy = time.thread_time()
    assert station.receive(0.4) == b""
    assert time.thread_time() - busy < 0.1
    later.join()
