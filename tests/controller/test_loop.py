"""The loop over real UDP sockets."""

import threading
import time

import numpy as np
import pytest

from laglab_control import StationConfig
from laglab_protocol import (
    STATION_HEARTBEAT,
    Command,
    End,
    EndReason,
    Heartbeat,
    Listener,
    Measurement,
    Receiver,
    Sender,
    Settings,
    Tick,
    frames_in,
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


def test_a_port_that_breaks_while_a_robot_is_waited_for_gets_its_time_to_come_back(tmp_path):
    """However long that wait was."""
    path, results = tmp_path / "robot", []
    with open_endpoint(f"pty://{path}") as robot:
        station = open_endpoint(f"serial://{path}:57600")
        options = {"silence_timeout": 2.5}
        thread = threading.Thread(target=run, args=(station, results), kwargs=options)
        thread.start()
        time.sleep(2.8)
    with station, open_endpoint(f"pty://{path}") as robot:
        time.sleep(0.2)
        drive(robot, Tick(0, 0), End(0, EndReason.COMPLETED))
        thread.join(5)
    assert results == [End(0, EndReason.COMPLETED)]


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
    no_settings, gain = sorted(onlooker.warnings)
    assert no_settings == "the robot does not tell its settings"
    assert gain.startswith("tick 5: popf's gain is")


def test_a_robot_that_falls_silent_is_named_with_its_last_tick(link):
    robot, station = link
    results = []
    thread = threading.Thread(target=run, args=(station, results), kwargs={"silence_timeout": 2.5})
    thread.start()
    began = time.monotonic()
    drive(robot, Tick(0, 0), Tick(1, 0))
    thread.join(20)
    assert time.monotonic() - began > 2.5
    assert "the robot has been silent for 2.5 s, since its tick 1" in str(results[0])


class HeldUp(Listener):
    """Once, between a look that finds nothing and the clock."""

    def __init__(self, endpoint):
        super().__init__(endpoint, Receiver())
        self.met, self.held_up = False, threading.Event()

    def listen(self, timeout):
        frames = super().listen(timeout)
        self.met |= bool(frames)
        if self.met and not frames and not self.held_up.is_set():
            self.held_up.set()
            time.sleep(2.7)
        return frames


def test_who_is_held_up_does_not_take_the_robot_for_silent(link):
    robot, endpoint = link
    listener, results = HeldUp(endpoint), []
    config = StationConfig(estimator="raw")
    thread = threading.Thread(
        target=lambda: results.append(run_station(Station(config), listener, 2.5))
    )
    thread.start()
    drive(robot, Tick(0, 0))
    assert listener.held_up.wait(10)
    robot.send(Sender(1, 1).frame(End(0, EndReason.COMPLETED)))
    thread.join(20)
    assert results == [End(0, EndReason.COMPLETED)]


def test_a_robot_that_leaves_when_it_hears_of_the_end_is_not_waited_for(tmp_path):
    """A serial port is gone with it, and what it said last."""
    config, results = StationConfig(estimator="raw"), []
    with open_endpoint(f"pty://{tmp_path / 'robot'}") as robot:
        station = open_endpoint(f"serial://{tmp_path / 'robot'}:57600")
        listener = Listener(station, Receiver())
        thread = threading.Thread(
            target=lambda: results.append(run_station(Station(config), listener, 60.0))
        )
        thread.start()
        lost = [Measurement(2000.0, 0.0, 0.0, 0.0, 0.0, 0, -1), Tick(1, 1)]
        assert any(isinstance(heard, End) for heard in drive(robot, Tick(0, 0), lost))
    thread.join(20)
    assert results == [End(1, EndReason.DIVERGED)], "it waits for its port to come back"
    station.close()


@pytest.fixture
def waiting():
    """A station that waits at an address of its own, a call that awaits what its run gave, and
    what it warns of."""
    results, onlooker = [], Warned()
    options = {"silence_timeout": 3.0, "onlooker": onlooker}
    with open_endpoint("udpin://127.0.0.1:0") as endpoint:
        thread = threading.Thread(target=run, args=(endpoint, results), kwargs=options)
        thread.start()

        def outcome():
            thread.join(5)
            return results

        yield endpoint.name.replace("udpin", "udpout"), outcome, onlooker.warnings
        thread.join(5)


@pytest.mark.parametrize("speaker", [(7, 1), (1, 1)])
def test_a_tick_of_somebody_who_never_answers_locks_no_station(waiting, speaker):
    """Not even in the robot's name: when the robot comes, it is met."""
    url, outcome, warnings = waiting
    with open_endpoint(url) as stranger:
        stranger.send(Sender(*speaker).frame(Tick(5000, 0)))
    with open_endpoint(url) as robot:
        knock, receiver = Sender(1, 1), Receiver()
        until = time.monotonic() + 5
        heard = []
        while not any(isinstance(each.message, Command) for each in heard):
            robot.send(knock.frame(Tick(0, 0)))
            heard = receiver.receive(robot.receive(0.1), True)
            assert time.monotonic() < until
        drive(robot, Tick(1, 0), End(1, EndReason.COMPLETED))
    assert outcome() == [End(1, EndReason.COMPLETED)]
    named = "system 7, component 1 ticks there: a robot must be system 1, component 1"
    assert sum(named in text for text in warnings) == (speaker == (7, 1))


def test_a_stray_tick_takes_no_station_from_its_robot(waiting):
    """Not even after a single word of the robot's."""
    url, outcome, _ = waiting
    with open_endpoint(url) as robot, open_endpoint(url) as stranger:
        robot.send(Sender(1, 1).frame(Tick(0, 0)))
        heard = []
        while not any(isinstance(each.message, Command) for each in heard):
            heard = frames_in(robot.receive(5.0))
        stranger.send(Sender(1, 1).frame(Tick(5000, 0)))
        time.sleep(0.1)
        drive(robot, Tick(1, 0), End(1, EndReason.COMPLETED))
    assert outcome() == [End(1, EndReason.COMPLETED)]


def test_a_robot_that_knocks_after_a_stray_tick_is_called_at_once(waiting):
    """And is not blamed for what who said one thing and went has not told."""
    url, outcome, warnings = waiting
    with open_endpoint(url) as stranger:
        stranger.send(Sender(1, 1).frame(Tick(0, 0)))
        assert frames_in(stranger.receive(5.0)), "it is taken for the robot"
    with open_endpoint(url) as robot:
        robot.send(Sender(1, 1).frame(Heartbeat(0, 10, 0, 0, 4, 3)))
        assert STATION_HEARTBEAT in [each.message for each in frames_in(robot.receive(2.5))]
        settings = Settings(StationConfig().model.sample_time)
        drive(robot, [settings, Tick(0, 0)], Tick(1, 0), End(1, EndReason.COMPLETED))
    assert outcome() == [End(1, EndReason.COMPLETED)]
    assert warnings == []
