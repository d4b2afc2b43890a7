"""A session as the frames of both directions tell it."""

import numpy as np
import pytest

from laglab_control import RobotModel, StationConfig
from laglab_protocol import (
    Command,
    End,
    Measurement,
    Plan,
    Planned,
    Receiver,
    Sender,
    Tick,
    frames_in,
)
from laglab_station import SessionTick, Station, shadow
from laglab_station.session import heard


def frames(*messages):
    """The robot's, and the station's where the message is of a command."""
    robot, station = Sender(1, 1), Sender(200, 190)
    senders = [station if isinstance(message, Command | Plan) else robot for message in messages]
    pairs = zip(senders, messages, strict=True)
    return [frame for sender, message in pairs for frame in frames_in(sender.frame(message))]


def z(tick, x=0.0):
    return Measurement(x, 0.0, 0.0, 0.0, 0.0, tick, -1)


def u(tick):
    return Command(1.0, 0.5, tick, 1, 1, 0)


def test_each_tick_once_with_what_arrived_and_what_was_sent():
    told = heard(frames(Tick(0, 0), u(0), z(0), z(1), Tick(1, 2), u(1), End(1, 0)))
    assert list(told) == [SessionTick(0, (), u(0)), SessionTick(1, (z(0), z(1)), u(1))]


def test_repeats_and_what_is_not_whole_are_passed_over():
    told = heard(frames(z(0), Tick(0, 2), z(0), Tick(0, 1), z(0), Tick(0, 1), u(0), u(0)))
    assert list(told) == [SessionTick(0, (z(0),), u(0))]


def test_a_plan_that_comes_late_is_not_the_next_commands():
    plan = Planned(Command(1.0, 0.5, 0, 1, 1, 0, 1), 0, ((9.0, 9.0),))
    told = heard(frames(Tick(0, 0), plan.command, Tick(1, 0), *plan.frames(), u(1)))
    assert list(told) == [SessionTick(0, (), plan.command), SessionTick(1, (), u(1))]


def test_a_robot_that_begins_again_goes_on_in_the_session():
    """From where the station meets it; an old tick that only comes late is none of it."""
    first = [message for k in range(50) for message in (z(k), Tick(k, 1), u(k))]
    late = [z(30), Tick(30, 1)]
    again = [message for k in range(25) for message in (z(k), Tick(k, 1), u(k))]
    told = list(heard(frames(*first, *late, *again)))
    assert [each.tick for each in told] == [*range(50), *range(19, 25)]
    assert all(each.measurements == (z(each.tick),) for each in told)
    lockstep = [*first, *[z(0), Tick(0, 1)] * 4, u(0), z(1), Tick(1, 1)]
    assert [each.tick for each in heard(frames(*lockstep))] == [*range(50), 0, 1]


def test_a_shadow_ends_where_the_robot_begins_again():
    session = [SessionTick(k, (), u(k)) for k in (*range(5), *range(9))]
    assert [row.tick for row in shadow(StationConfig(), session)] == list(range(5))


def test_over_lost_ticks_a_shadow_goes_on_by_the_plan():
    config = StationConfig(estimator="delayed-ekf", initial_estimate=(1.0, 0.0, 0.0), plan=3)
    following = ((0.6, 0.1), (0.7, 0.2), (0.8, 0.3))
    planned = Command(0.5, 0.0, 0, 1, 1, 0, 3)
    session = [SessionTick(0, (), planned, following=following), SessionTick(4, (), None)]
    *_, last = shadow(config, session)
    x = np.array((1.0, 0.0, 0.0))
    for speeds in (planned.speeds, *following):
        x = RobotModel().f(x, np.array(speeds))
    np.testing.assert_allclose(last.x, x, rtol=0, atol=1e-12)


def test_nothing_at_all():
    assert list(heard([])) == []
    assert list(shadow(StationConfig(), [])) == []


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
        answer = b"".join(station.hear(frames_in(b"".join(map(robot.frame, messages)))))
        estimate, command = (frame.message for frame in receiver.receive(answer))
        session.append(SessionTick(k, tuple(batch), command))
        said.append(estimate.pose)
    replayed = list(shadow(config, session))
    np.testing.assert_array_equal([row.x for row in replayed], said)
    assert [row.tick for row in replayed] == [heard.tick for heard in session]


def test_what_strangers_say_is_not_the_robots():
    """A log may hold the frames of others: of another robot, another station, a ground station."""
    ours = frames(Tick(0, 0), u(0), z(0), Tick(1, 1), u(1))
    others = [
        frame
        for sender, message in [
            (Sender(7, 1), z(0, 50.0)),
            (Sender(7, 1), Tick(4_000_000, 1)),
            (Sender(255, 190), u(1)),
            (Sender(1, 99), Tick(2, 0)),
        ]
        for frame in frames_in(sender.frame(message))
    ]
    mixed = [frame for pair in zip(ours, [*others, others[0]], strict=True) for frame in pair]
    assert list(heard(mixed)) == list(heard(ours))
