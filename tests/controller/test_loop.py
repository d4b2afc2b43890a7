"""The loop over real UDP sockets."""

import threading
import time

import numpy as np
import pytest

from laglab_control import StationConfig
from laglab_protocol import (
    Command,
    End,
    EndReason,
    Listener,
    Measurement,
    Receiver,
    Sender,
    Tick,
    open_endpoint,
)
from laglab_station import Onlooker, RobotSilentError, Station, run_station


@pytest.fixture
def link():
    """Two endpoints that hear each other."""
    with (
        open_endpoint("udpin://127.0.0.1:0") as robot,
        open_endpoint(robot.name.replace("udpin", "udpout")) as station,
    ):
        yield robot, station


def drive(endpoint, *messages):
    """A robot that says each message, or list of messages, until it is answered; what it heard."""
    sender, receiver, heard = Sender(1, 1), Receiver(), []
    while not endpoint.receive(1.0):
        pass
    endpoint.accept_peer()
    for message in messages:
        together = message if isinstance(message, list) else [message]
        endpoint.send(b"".join(map(sender.frame, together)))
        while not (answer := [f.message for f in receiver.receive(endpoint.receive(1.0))]) or (
            not isinstance(answer[-1], (Command, End))
        ):
            endpoint.send(b"".join(map(sender.frame, together)))
        heard += answer
    return heard


class Warned(Onlooker):
    def __init__(self):
        self.warnings = []

    def warned(self, text):
        self.warnings.append(text)


def run(endpoint, results, **options):
    listener = Listener(endpoint, Receiver())
    try:
        results.append(run_station(Station(StationConfig()), listener, **options))
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


def test_a_warning_is_passed_on_once(link):
    robot, endpoint = link
    config = StationConfig(estimator="popf", initial_covariance=np.eye(3))
    onlooker = Warned()
    listener = Listener(endpoint, Receiver())
    thread = threading.Thread(target=run_station, args=(Station(config), listener, 3.0, onlooker))
    thread.start()
    measured = [Measurement(0.0, 0.0, 0.0, 0.0, 0.0, 0, -1), Tick(5, 1)]
    drive(robot, Tick(0, 0), measured, Tick(6, 0), End(6, EndReason.COMPLETED))
    thread.join(5)
    no_settings, gain = onlooker.warnings
    assert no_settings == "the robot does not tell its settings"
    assert gain.startswith("tick 5: popf's gain is")


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
