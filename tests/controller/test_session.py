"""A session as the frames of both directions tell it."""

import numpy as np
import pytest

from laglab_control import StationConfig
from laglab_protocol import Command, End, Measurement, Receiver, Sender, Tick
from laglab_station import Heard, Station, shadow
from laglab_station.session import heard


def frames(*messages):
    sender, receiver = Sender(1, 1), Receiver()
    return [f for message in messages for f in receiver.receive(sender.frame(message))]


def z(tick, x=0.0):
    return Measurement(x, 0.0, 0.0, 0.0, 0.0, tick, -1)


def u(tick):
    return Command(1.0, 0.5, tick, 1, 1, 0)


def test_each_tick_once_with_what_arrived_and_what_was_sent():
    told = heard(frames(Tick(0, 0), u(0), z(0), z(1), Tick(1, 2), u(1), End(1, 0)))
    assert list(told) == [Heard(0, (), u(0)), Heard(1, (z(0), z(1)), u(1))]


def test_repeats_and_what_is_not_whole_are_passed_over():
    told = heard(frames(z(0), Tick(0, 2), z(0), Tick(0, 1), z(0), Tick(0, 1), u(0), u(0)))
    assert list(told) == [Heard(0, (z(0),), u(0))]


def test_nothing_at_all():
    assert list(heard([])) == []
    assert shadow(StationConfig(), []).estimates.shape == (0, 3)


@pytest.mark.parametrize("estimator", ["popf", "delayed-ekf"])
def test_the_shadow_of_a_station_says_what_the_station_said(estimator):
    """Measurements late, missing and out of order; a tick lost; commands on their way."""
    config = StationConfig(estimator=estimator, initial_estimate=(1.0, 0.0, 0.0), command_delay=3)
    station, robot, receiver = Station(config), Sender(1, 1), Receiver()
    random = np.random.default_rng(5)
    session, said = [], []
    for k in [0, 1, 2, 3, 5, 6, 7, 8, 9, 10]:
        batch = [z(int(s), float(random.normal(1, 0.1))) for s in random.permutation(k)[:2]]
        messages = [*batch, Tick(k, len(batch))]
        answer = station.receive(b"".join(map(robot.frame, messages)), datagram=True)
        estimate, command = (frame.message for frame in receiver.receive(answer))
        session.append(Heard(k, tuple(batch), command))
        said.append(estimate.pose)
    replayed = shadow(config, session)
    np.testing.assert_array_equal(replayed.estimates, said)
    assert replayed.ticks.tolist() == [heard.tick for heard in session]
