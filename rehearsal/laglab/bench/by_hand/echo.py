"""Two processes that send each other as many bytes as a tick needs, and do nothing else."""

import os
import socket
from collections.abc import Callable
from queue import Queue
from time import perf_counter
from typing import Literal

from msgspec import Struct

from laglab.runs.processes.child import Tell, started
from laglab_protocol import Command, Estimate, Measurement, Message, Sender, Tick

POSE = (0.1, 0.1, 0.1)
COVARIANCE = (0.1, 0.1, 0.1, 0.1, 0.1, 0.1)
"""Any doubles whose last byte is not zero, so that no frame is cut short."""

Link = Literal["udp", "serial"]


class EchoOrder(Struct, frozen=True):
    """Whom to answer, and how often."""

    address: str
    port: int
    sizes: "Sizes"
    ticks: int


Send = Callable[[bytes], object]
Receive = Callable[[int], bytes]
"""Answers at most as many bytes as it is given."""


class Sizes(Struct, frozen=True):
    """Bytes that go each way in a tick."""

    to_station: int
    to_robot: int


def tick_sizes(estimates: bool) -> Sizes:
    """Those of a tick with one measurement, answered with or without an estimate."""
    measurement = Measurement(*POSE, 0.1, 0.1, 1, 1)
    answer: list[Message] = [Command(0.1, 0.1, 1, 1, 1, int(estimates))]
    if estimates:
        answer.append(Estimate(*POSE, *COVARIANCE, 1))
    return Sizes(_size([measurement, Tick(1, 1)]), _size(answer))


def _size(messages: list[Message]) -> int:
    sender = Sender(1, 1)
    return sum(len(sender.frame(message)) for message in messages)


def seconds_per_echo(link: Link, sizes: Sizes, ticks: int) -> float:
    """Wall time [s] of one round trip, over `ticks` of them."""
    return _over_udp(sizes, ticks) if link == "udp" else _over_pty(sizes, ticks)


def _over_udp(sizes: Sizes, ticks: int) -> float:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as robot:
        robot.bind(("127.0.0.1", 0))
        host, port = robot.getsockname()
        order = EchoOrder(host, port, sizes, ticks)
        with started("echo", "laglab.bench.by_hand.echo:udp_station", order, Queue()):
            _, station = robot.recvfrom(1)
            robot.connect(station)
            return _call(robot.send, robot.recv, sizes, ticks)


def udp_station(order: EchoOrder, _: Tell) -> None:
    """Answers over a socket."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as station:
        station.connect((order.address, order.port))
        station.send(b"?")
        _answer(station.send, station.recv, order)


def _over_pty(sizes: Sizes, ticks: int) -> float:
    import tty  # not every system has it

    robot, slave = os.openpty()
    tty.setraw(slave)
    try:
        order = EchoOrder(os.ttyname(slave), 0, sizes, ticks)
        with started("echo", "laglab.bench.by_hand.echo:pty_station", order, Queue()):
            os.read(robot, 1)
            return _call(
                lambda data: os.write(robot, data), lambda size: os.read(robot, size), sizes, ticks
            )
    finally:
        os.close(robot)
        os.close(slave)


def pty_station(order: EchoOrder, _: Tell) -> None:
    """Answers over a terminal."""
    station = os.open(order.address, os.O_RDWR | os.O_NOCTTY)
    os.write(station, b"?")
    _answer(lambda data: os.write(station, data), lambda size: os.read(station, size), order)
    os.close(station)


def _call(send: Send, receive: Receive, sizes: Sizes, ticks: int) -> float:
    request = bytes(sizes.to_station)
    began = perf_counter()
    for _ in range(ticks):
        send(request)
        _whole(receive, sizes.to_robot)
    return (perf_counter() - began) / ticks


def _answer(send: Send, receive: Receive, order: EchoOrder) -> None:
    answer = bytes(order.sizes.to_robot)
    for _ in range(order.ticks):
        _whole(receive, order.sizes.to_station)
        send(answer)


def _whole(receive: Receive, size: int) -> None:
    """A datagram comes at once, a stream in pieces."""
    while size > 0:
        size -= len(receive(size))
