"""The station core at the level of frames."""

import numpy as np
import pytest

from laglab_control import (
    ControlError,
    Controller,
    PluginFailedError,
    PolarLaw,
    RobotModel,
    StationConfig,
)
from laglab_protocol import (
    NO_COMMAND,
    Command,
    End,
    EndReason,
    Estimate,
    Heartbeat,
    Measurement,
    Receiver,
    Sender,
    Settings,
    Tick,
    frames_in,
)
from laglab_station import Station
from laglab_station.station import LONGEST_GAP

START = (-3.0, -3.0, 0.5)


def make(estimator="popf", n=0, **config):
    return Station(
        StationConfig(
            estimator=estimator,
            initial_estimate=START,
            command_delay=n,
            **config,
        )
    )


class Robot:
    """Makes the robot's datagrams and reads the station's answers."""

    def __init__(self, station, system=1, component=1):
        self.station = station
        self._sender = Sender(system, component)
        self._receiver = Receiver()

    def datagram(self, tick, *poses, announced=None):
        """One measurement per (s, pose), then the tick."""
        messages = [Measurement(*pose, 0.0, 0.0, s, NO_COMMAND) for s, pose in poses]
        count = len(poses) if announced is None else announced
        return b"".join(map(self._sender.frame, [*messages, Tick(tick, count)]))

    def say(self, data):
        answer = b"".join(self.station.hear(frames_in(data)))
        return [frame.message for frame in self._receiver.receive(answer)]

    def tick(self, tick, *poses):
        return self.say(self.datagram(tick, *poses))

    def drive(self, tick, measurement):
        """One tick of a robot that echoes what it does."""
        return self.say(b"".join(map(self._sender.frame, [measurement, Tick(tick, 1)])))

    def end(self, tick, reason):
        return self.say(self._sender.frame(End(tick, reason)))


def test_a_tick_is_answered_with_estimate_and_command():
    robot = Robot(make())
    estimate, command = robot.tick(0)
    assert estimate == Estimate(*START, 1e-4, 0, 0, 1e-4, 0, 1e-4, tick=0)
    v, omega, _ = PolarLaw().drive(START, 0.0, None)
    assert command == Command(v, omega, 0, 1, 1, estimates=1)


def test_raw_sends_no_estimate_and_stands_still_until_the_first_measurement():
    robot = Robot(make("raw"))
    assert robot.tick(0) == [Command(0, 0, 0, 1, 1, estimates=0)]
    pose = (-1.0, 2.0, 0.3)
    (command,) = robot.tick(1, (0, pose))
    assert command.speeds == PolarLaw().drive(pose, 0.0, None)[:2]


def test_the_input_applied_is_the_command_sent_n_ticks_earlier():
    n, robot, model = 2, Robot(make(n=2)), RobotModel()
    sent, x = [], np.array(START)
    for k in range(6):
        if k:
            x = model.f(x, np.array(sent[k - 1 - n]) if k - 1 - n >= 0 else np.zeros(2))
        estimate, command = robot.tick(k)
        sent.append(command.speeds)
        assert estimate.pose == pytest.approx(x, abs=1e-15)


@pytest.mark.parametrize("estimator", ["raw", "popf", "delayed-ekf"])
def test_a_repeated_tick_gets_the_same_answer_and_changes_nothing(estimator):
    once, twice = Robot(make(estimator)), Robot(make(estimator))
    for k in range(5):
        measured = (k, (-3.0, -3.0 + k, 0.5))
        first = twice.tick(k, measured)
        assert twice.tick(k, measured) == first
        assert twice.tick(k, measured) == first == once.tick(k, measured)


def test_a_tick_whose_measurements_did_not_all_arrive_is_not_answered():
    robot, whole = Robot(make()), Robot(make())
    measured = (0, (-3.1, -3.0, 0.5))
    assert robot.say(robot.datagram(0, announced=1)) == []
    assert robot.station.tick is None
    assert robot.tick(0, measured) == whole.tick(0, measured)


def test_garbage_and_other_senders_are_passed_over():
    robot, other = Robot(make()), Robot(make())
    stranger = Robot(robot.station, system=9)
    assert robot.say(b"\xfd\x00garbage\xff" * 9) == []
    assert robot.tick(0) == other.tick(0)
    assert stranger.tick(7) == []
    assert stranger.end(0, EndReason.FAILED) == []
    assert robot.station.outcome is None
    assert robot.tick(1) == other.tick(1)


def test_ticks_of_the_past_and_measurements_of_the_future_are_passed_over():
    robot, other = Robot(make()), Robot(make())
    for k in range(3):
        future = (k + 1, (9.0, 9.0, 9.0))
        assert robot.tick(k, future) == other.tick(k)
    assert robot.tick(1) == []


def test_after_lost_ticks_it_goes_on_from_the_present_one():
    """In the meantime the robot held the last command."""
    robot, model = Robot(make()), RobotModel()
    _, command = robot.tick(0)
    estimate, _ = robot.tick(4)
    x = np.array(START)
    for _ in range(4):
        x = model.f(x, np.array(command.speeds))
    assert estimate.pose == pytest.approx(x, abs=1e-15)


def test_over_lost_ticks_a_robot_goes_on_by_its_plan():
    robot, model = Robot(make(plan=8)), RobotModel()
    *_, plan, command = robot.tick(0)
    estimate, *_ = robot.tick(4)
    x = np.array(START)
    for u in [command.speeds, *zip(plan.v, plan.omega, strict=True)][:4]:
        x = model.f(x, np.array(u))
    assert estimate.pose == pytest.approx(x, abs=1e-15)


@pytest.mark.parametrize(("gap", "anew"), [(LONGEST_GAP, False), (LONGEST_GAP + 1, True)])
def test_a_robot_unheard_for_longer_than_anybody_remembers_is_met_anew(gap, anew):
    robot = Robot(make())
    robot.tick(0)
    assert (robot.tick(gap) == [Command(0, 0, gap, 1, 1, 0)]) is anew


def test_a_robot_that_is_under_way_is_stopped_and_taken_over_from_where_it_stands():
    robot, n, here = Robot(make(n=3)), 3, np.array((1.0, -2.0, 3.1))
    rng, sent = np.random.default_rng(1), []
    for tick in range(5000, 5400):
        v = sent[tick - 5000 - n - 1].v if tick - 5000 > n else 0.7
        z = here + rng.normal(0, (0.1, 0.1, 0.13))
        *estimates, command = robot.drive(tick, Measurement(*z, v, 0.0, tick, tick - 1 - n))
        sent.append(command)
        if estimates:
            break
    assert all((earlier.v, earlier.omega) == (0, 0) for earlier in sent[:-1])
    assert len(sent) == 100 + n + 1
    assert estimates[0].pose == pytest.approx(here, abs=0.05)
    assert sent[-1].v != 0


@pytest.mark.parametrize("estimator", ["raw", "ekf", "delayed-ekf"])
@pytest.mark.parametrize("bad", [(np.nan, 0.0, 0.0), (0.0, np.inf, 0.0), (0.0, 0.0, np.inf)])
def test_an_estimate_that_is_not_finite_stops_the_robot_and_ends_the_run(estimator, bad):
    robot = Robot(make(estimator, initial_covariance=np.eye(3)))
    robot.tick(0)
    *estimates, end, command = robot.tick(1, (1, bad))
    assert command == Command(0, 0, 1, 1, 1, len(estimates))
    assert len(estimates) == (estimator != "raw")
    assert end == robot.station.outcome == End(1, EndReason.DIVERGED)
    assert robot.tick(1)[-2:] == [end, command]
    assert robot.tick(2) == []
    assert not robot.station.closed
    assert robot.end(1, EndReason.DIVERGED) == []
    assert robot.station.closed


GOAL = (5000.0, 5000.0, 0.0)
BEGIN = (4100.0, 5000.0, 0.0)


@pytest.mark.parametrize(
    ("x", "diverged"),
    [(5999.0, False), (6001.0, True), (3101.0, False), (3099.0, True), (0.0, True)],
)
def test_a_kilometre_from_both_goal_and_first_estimate_is_diverged(x, diverged):
    law = PolarLaw(goal=GOAL)
    config = StationConfig(estimator="raw", law=law, goal=GOAL, initial_estimate=BEGIN)
    robot = Robot(Station(config))
    robot.tick(0, (0, (x, 5000.0, 0.0)))
    assert (robot.station.outcome is not None) is diverged


class Clock:
    """A law that writes down for which times it is asked."""

    def __init__(self):
        self.asked = []

    def drive(self, pose, time, memory):
        self.asked.append(round(time, 6))
        return 0.0, 0.0, None


def test_the_time_of_the_law_is_the_robots_whenever_the_station_met_it():
    law = Clock()
    robot = Robot(make("raw", n=3, law=law))
    for tick in (500, 501):
        robot.tick(tick, (tick, START))
    assert law.asked == [5.03, 5.04]
    taken = Clock()
    robot = Robot(make("delayed-ekf", n=3, law=taken))
    for tick in range(500, 603):
        robot.drive(tick, Measurement(*START, 0.0, 0.0, tick, tick - 1 - 3))
    assert taken.asked[:2] == [6.02, 6.03]
    for _ in range(4):  # it begins again, and so does its time
        robot.tick(0, (0, START))
    assert taken.asked[-1] == 0.03


def test_of_a_robot_that_begins_again_and_cannot_be_driven_the_end_is_its_own():
    made = []

    def once(config):
        made.append(config)
        if len(made) > 1:
            raise PluginFailedError("only once")
        return Controller(config)

    robot = Robot(Station(StationConfig(estimator="raw"), once))
    for tick in range(50):
        robot.tick(tick, (tick, START))
    for _ in range(3):
        assert robot.tick(0, (0, START)) == []
    with pytest.raises(PluginFailedError):
        robot.tick(0, (0, START))
    (end,) = frames_in(b"".join(robot.station.end(EndReason.FAILED)))
    assert end.message == End(0, EndReason.FAILED)


@pytest.mark.parametrize("there", [(2000.0, 0.0, 0.0), (np.nan, 0.0, 0.0)])
def test_a_robot_under_way_that_stands_where_no_run_leads_is_not_taken_over(there):
    robot = Robot(make())
    for tick in range(5000, 5099):
        assert robot.tick(tick, (tick, there)) == [Command(0, 0, tick, 1, 1, 0)]
    end = End(5099, EndReason.DIVERGED)
    assert robot.tick(5099, (5099, there)) == [end, Command(0, 0, 5099, 1, 1, 0)]
    assert robot.station.outcome == end


def test_the_robots_end_is_answered_once_with_the_same():
    robot = Robot(make())
    robot.tick(0)
    assert robot.end(8, EndReason.COMPLETED) == [End(8, EndReason.COMPLETED)]
    assert robot.station.outcome == End(8, EndReason.COMPLETED)
    assert robot.end(8, EndReason.COMPLETED) == []
    assert robot.station.closed


def test_heartbeat_says_ground_station():
    settings, frame = frames_in(b"".join(make().heartbeat()))
    assert isinstance(settings.message, Settings), (
        "before a run begins, wherever it comes in pieces"
    )
    assert isinstance(frame.message, Heartbeat)
    assert (frame.system, frame.component, frame.message.type) == (200, 190, 6)


@pytest.mark.parametrize(
    ("config", "said"),
    [
        ({"estimator": "best"}, "no estimator 'best': take one of raw, "),
        ({"command_delay": -1}, "command_delay must be a whole number of 0 or more, not -1"),
        ({"initial_estimate": (0, 0)}, r"initial_estimate must have shape \(3,\), not \(2,\)"),
        ({"initial_covariance": 1.0}, r"initial_covariance must have shape \(3, 3\), not \(\)"),
    ],
)
def test_a_bad_config_is_named(config, said):
    with pytest.raises(ControlError, match=said):
        StationConfig(**config)
