"""A station that is slower than the ticks answers the newest, and uses what all have brought."""

import threading
import time

import pytest

from laglab_control import Controller, StationConfig
from laglab_protocol import (
    NO_COMMAND,
    Command,
    End,
    EndReason,
    Estimate,
    Listener,
    Measurement,
    Receiver,
    Sender,
    Tick,
    frames_in,
    open_endpoint,
)
from laglab_station import Station, run_station

START = (-3.0, -3.0, 0.5)
TICK, ANSWER = 0.025, 0.0875
"""[s] How often the robot speaks, and what an answer takes."""


class Robot:
    """Stands at START, and says so at each tick."""

    def __init__(self):
        self._sender = Sender(1, 1)

    def says(self, tick, *sampled, announced=None):
        said = [Measurement(*START, 0.0, 0.0, s, NO_COMMAND) for s in sampled]
        count = len(said) if announced is None else announced
        return b"".join(map(self._sender.frame, [*said, Tick(tick, count)]))


def make(estimator="delayed-ekf", **options):
    config = StationConfig(estimator=estimator, initial_estimate=START, command_delay=2)
    return Station(config, **options)


def told(answer):
    return [frame.message for frame in frames_in(b"".join(answer))]


def heard(station, *datagrams):
    return told(station.hear_backlog(frames_in(b"".join(datagrams))))


@pytest.fixture
def robot():
    return Robot()


@pytest.fixture
def station(robot):
    """One that has answered tick 0."""
    station = make()
    assert heard(station, robot.says(0))
    return station


def test_the_newest_is_answered_with_what_all_have_brought(robot, station):
    behind = heard(station, *(robot.says(k, k - 1) for k in range(1, 6)))
    other = make()
    heard(other, robot.says(0))
    at_once = heard(other, robot.says(5, *range(5)))
    assert [type(message) for message in behind] == [Estimate, Command]
    assert behind == at_once
    assert station.tick == 5
    assert station.warnings == (
        "tick 1 was passed over: answers take longer than ticks, and a newer one had come",
    )


def test_nothing_is_passed_over_where_nothing_waits(robot, station):
    assert heard(station, robot.says(1, 0))[-1].tick == 1
    assert [message.tick for message in heard(station, robot.says(1, 0))] == [1, 1]
    assert station.warnings == ()


def test_a_repeat_was_not_passed_over(robot, station):
    heard(station, robot.says(1, 0))
    answered = heard(station, robot.says(1, 0), robot.says(2, 1))
    assert [message.tick for message in answered] == [1, 1, 2, 2]
    assert station.warnings == ()


def test_what_is_not_whole_is_not_used(robot, station):
    behind = heard(station, robot.says(1, 0, announced=2), robot.says(2, 1))
    other = make()
    heard(other, robot.says(0))
    assert behind == heard(other, robot.says(2, 1))


def test_what_waited_of_a_robot_that_begins_again_is_not_the_new_ones(robot, station):
    """It would be newer than all that the new one measures, which would then be passed over."""
    heard(station, robot.says(200, 199))
    assert heard(station, robot.says(250, 249), robot.says(251, announced=1)) == []
    answers = [heard(station, robot.says(k, k)) for k in range(125)]  # from 19 on it is met anew
    assert not any(isinstance(each, Estimate) for answer in answers[:110] for each in answer)
    assert any(isinstance(each, Estimate) for answer in answers[110:] for each in answer)
    assert "the robot has begun again" in station.warnings


def test_a_robot_s_first_ticks_are_all_answered(robot):
    station = make()
    answered = heard(station, robot.says(0), robot.says(1, 0))
    assert [message.tick for message in answered if isinstance(message, Command)] == [0, 1]


def test_others_pass_nothing_over(robot, station):
    stranger = Sender(7, 1).frame(Tick(5000, 0))
    assert heard(station, robot.says(1, 0), stranger)[-1].tick == 1


def test_an_end_is_answered_all_the_same(robot, station):
    end = End(2, EndReason.COMPLETED)
    answered = heard(station, robot.says(1, 0), robot.says(2, 1), Sender(1, 1).frame(end))
    assert [message.tick for message in answered] == [2, 2, 2]
    assert answered[-1] == end


def test_with_play_out_nothing_is_late_that_came_in_time(robot):
    station = make(playout=3)
    heard(station, robot.says(0))
    heard(station, *(robot.says(k, k - 1) for k in range(1, 8)))
    assert station.report().late == 0


class Slow(Controller):
    """Takes its time."""

    def answer(self, *told):
        time.sleep(ANSWER)
        return super().answer(*told)


def drive(url, ticks):
    """A robot that waits for nobody: how old each answer's tick was when it came."""
    robot, receiver, ages = Robot(), Receiver(), []
    with open_endpoint(url) as link:
        began = time.monotonic()
        for k in range(ticks):
            link.send(robot.says(k, k))
            while (left := began + (k + 1) * TICK - time.monotonic()) > 0:
                frames = receiver.receive(link.receive(left), True)
                ages += [k - f.message.tick for f in frames if isinstance(f.message, Command)]
        link.send(Sender(1, 1).frame(End(ticks - 1, EndReason.COMPLETED)))
    return ages


def test_the_answers_of_a_slow_station_stay_fresh():
    """A hundred ticks, of which it can answer a quarter: none waits for those before it. Where all
    stands still for a moment answers are old, too, but not three times."""
    for _ in range(3):
        ages, warnings = answered_slowly()
        if 10 < len(ages) < 35 and max(ages) < 40:
            break
    assert 10 < len(ages) < 35
    assert max(ages) < 40  # as it ends it would be 70 otherwise
    behind = "answers take longer than ticks, and a newer one had come"
    assert any(each.endswith(behind) for each in warnings)


def answered_slowly():
    """How old the answers are, and what the station warns of."""
    with open_endpoint("udpin://127.0.0.1:0") as endpoint:
        station = Station(StationConfig(estimator="raw"), Slow)
        thread = threading.Thread(
            target=run_station, args=(station, Listener(endpoint, Receiver()))
        )
        thread.start()
        ages = drive(endpoint.name.replace("udpin", "udpout"), 100)
        thread.join(5)
    return ages, station.warnings
