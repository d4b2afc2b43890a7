"""The loop over real UDP sockets."""

import threading
import time

import pytest

from laglab_controller import RobotSilentError, Station, StationConfig, run_station
from laglab_protocol import Command, End, EndReason, Receiver, Sender, Tick, open_endpoint


@pytest.fixture
def link():
    """Two endpoints that hear each other."""
    with (
        open_endpoint("udpin://127.0.0.1:0") as robot,
        open_endpoint(robot.name.replace("udpin", "udpout")) as station,
    ):
        yield robot, station


def drive(endpoint, *messages):
    """A robot that says each message until it is answered; what it heard."""
    sender, receiver, heard = Sender(1, 1), Receiver(), []
    while not endpoint.receive(1.0):
        pass
    endpoint.accept_peer()
    for message in messages:
        endpoint.send(sender.frame(message))
        while not (answer := [f.message for f in receiver.receive(endpoint.receive(1.0))]) or (
            not isinstance(answer[-1], (Command, End))
        ):
            endpoint.send(sender.frame(message))
        heard += answer
    return heard


def run(endpoint, results, **options):
    try:
        results.append(run_station(Station(StationConfig()), endpoint, **options))
    except RobotSilentError as error:
        results.append(error)


def test_it_makes_itself_known_answers_and_ends(link):
    robot, station = link
    results = []
    thread = threading.Thread(target=run, args=(station, results))
    thread.start()
    heard = drive(robot, Tick(0, 0), Tick(1, 0), End(1, EndReason.COMPLETED))
    thread.join(5)
    assert results == [End(1, EndReason.COMPLETED)]
    assert [message.tick for message in heard if isinstance(message, Command)] == [0, 1]


def test_a_robot_that_falls_silent_is_named_with_its_last_tick(link):
    robot, station = link
    results = []
    thread = threading.Thread(target=run, args=(station, results), kwargs={"silence_timeout": 0.3})
    thread.start()
    drive(robot, Tick(0, 0), Tick(1, 0))
    silent_since = time.monotonic()
    thread.join(5)
    assert 0.2 < time.monotonic() - silent_since < 2
    assert "the robot has been silent for 0.3 s, since its tick 1" in str(results[0])
