"""The station learns from the echoes which command was in force, and how long commands take."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from laglab_control import (
    Controller,
    Echo,
    InForce,
    Measured,
    PolarLaw,
    RobotModel,
    StationConfig,
)
from laglab_control.flight import (
    FEW,
    GIVEN_UP,
    RECENT,
    Told,
    believed_sum,
    hear,
    send,
    sent_for,
    take_off,
)
from laglab_protocol import NO_COMMAND, Measurement, Receiver, Sender, Tick, frames_in
from laglab_station import Station

START = (-3.0, -3.0, 0.0)
LAW = PolarLaw()
MODEL = RobotModel()


class Link:
    """A robot without noise behind a link that loses, delays and repeats."""

    def __init__(self, estimator, believed_n, law=LAW):
        config = StationConfig(
            estimator=estimator, law=law, initial_estimate=START, command_delay=believed_n
        )
        self.controller, self.model = Controller(config), config.model
        self.control, self.k = self.controller.start(), 0
        self.poses, self.in_force = [np.array(START)], []
        self._coming = {}
        self._force = (np.zeros(2), None)
        self.arriving = {}

    def tick(self, command_delay, measurement_delays):
        """One tick; a delay of None is a loss, and `measurement_delays` lists every copy's."""
        k, pose = self.k, self.poses[-1]
        echo = [Echo(k - 1, *self.in_force[-1])] if k else []
        for delay in measurement_delays:
            self.arriving.setdefault(k + delay, []).append((Measured(k, pose), echo))
        arrived = self.arriving.pop(k, [])
        if k:
            self.control = self.controller.advance(self.control)
        self.control = self.controller.answer(
            self.control,
            [measured for measured, _ in arrived],
            [echo for _, echoes in arrived for echo in echoes],
        )
        if command_delay is not None:
            u = np.array(self.control.drive[:2])
            self._coming.setdefault(k + command_delay, []).append((u, k))
        for command in self._coming.pop(k, []):
            if self._force[1] is None or command[1] > self._force[1]:
                self._force = command
        self.in_force.append(self._force)
        self.poses.append(self.model.f(pose, self._force[0]))
        self.k += 1

    @property
    def error(self):
        return np.abs(self.control.estimate.x - self.poses[self.k - 1]).max()

    @property
    def n(self):
        return self.control.flight.command_delay


@pytest.mark.parametrize("estimator", ["popf", "popf-exact", "delayed-ekf"])
@pytest.mark.parametrize("believed_n", [0, 7, 30])
def test_a_wrong_n_is_found_out_and_what_it_spoilt_put_right(estimator, believed_n):
    link = Link(estimator, believed_n)
    for _ in range(120):
        link.tick(12, [5])
    assert link.n == 12
    assert link.error < 1e-9


@pytest.mark.parametrize("estimator", ["popf", "popf-exact", "delayed-ekf"])
def test_a_lost_command_is_put_right_when_the_echo_comes(estimator):
    link = Link(estimator, 4)
    for k in range(60):
        link.tick(None if k == 40 else 4, [6])
    errors = []
    for _ in range(20):
        link.tick(4, [6])
        errors.append(link.error)
    assert link.n == 4
    assert max(errors) < 1e-9


def test_the_loss_did_matter_meanwhile():
    link = Link("delayed-ekf", 4)
    errors = []
    for k in range(60):
        link.tick(None if k in (10, 11, 12) else 4, [6])
        errors.append(link.error)
    assert max(errors) > 1e-4
    assert errors[-1] < 1e-12


def test_a_command_that_is_held_tells_nothing_of_n():
    """Of each only the first echo does: no later command comes, so that of tick 20 is held."""
    link = Link("delayed-ekf", 4)
    for k in range(60):
        link.tick(4 if k <= 20 else None, [0])
    told = link.control.flight.told
    assert (link.n, told.spread, set(told.recent)) == (4, 0.0, {4})


def test_up_to_where_the_inputs_are_settled():
    gap = tuple(range(10, 40))
    assert Told(known=50, missing=gap).settled == 9
    assert Told(known=50, missing=gap[:FEW]).settled == 50
    assert Told(known=15 + GIVEN_UP, missing=gap).settled == 15
    assert Told(known=20 + GIVEN_UP, missing=gap).settled == 20 + GIVEN_UP


def numbered(n, count):
    """After `count` commands (1, 10), (2, 20) ..., of which each is to take n ticks."""
    flight = take_off(MODEL, n)
    for k in range(count):
        flight, _ = send(MODEL, flight, np.array((k + 1.0, 10.0 * (k + 1))))
    return flight


def test_the_inputs_believed_are_the_commands_n_ticks_later_from_the_first_on():
    flight = numbered(3, 5)
    assert [sent_for(flight, tick)[0] for tick in range(5)] == [0.0, 0.0, 0.0, 1.0, 2.0]
    assert [believed_sum(flight, since) for since in (0, 3, 4, 5)] == [
        (3.0, 30.0),
        (3.0, 30.0),
        (2.0, 20.0),
        (0.0, 0.0),
    ]


def test_with_another_n_all_that_is_on_its_way_is_believed_to_take_it_at_once():
    flight, inputs = hear(MODEL, numbered(2, 6), [Echo(4, np.array((1.0, 10.0)), 0)])
    assert flight.command_delay == 4
    assert [u[0] for u in flight.in_flight] == [3.0, 4.0, 5.0, 6.0]
    assert [(each.tick, each.u[0]) for each in inputs] == [(4, 1.0), (5, 2.0)]
    flight, inputs = hear(MODEL, flight, [Echo(5, np.array((2.0, 20.0)), 1)])
    assert [(each.tick, each.u[0]) for each in inputs] == [(5, 2.0)]


def test_the_first_command_that_takes_no_time_tells_of_it_too():
    flight, _ = hear(MODEL, numbered(4, 1), [Echo(0, np.array((1.0, 10.0)), 0)])
    assert (flight.command_delay, flight.told.known, flight.told.missing) == (0, 0, ())


def test_n_is_the_median_and_a_delay_is_noticed_after_however_many_equal_ones():
    assert Told(recent=(9, 1, 2, 4, 3), spread=1.0).usual_delay(otherwise=0) == 3
    told = Told(recent=(4,) * RECENT, newest=50, known=54)
    told, _ = told.after(60, [Echo(57, np.zeros(2), 51)], [])
    assert told.recent == (4,) * (RECENT - 1) + (6,)
    assert told.spread == pytest.approx(np.std(told.recent))


def test_what_nobody_told_of_is_known_tick_by_tick_and_the_input_before_it():
    u = [np.array((k + 1.0, 0.0)) for k in range(20)]
    told, _ = Told().after(6, [Echo(2, u[2], None)], [])
    assert (told.missing, told.before.tolist(), told.usual) == ((0, 1), [0.0, 0.0], 3)
    told, _ = told.after(9, [Echo(5, u[5], None)], [])
    assert (told.missing, told.before.tolist()) == ((0, 1, 3, 4), [0.0, 0.0])
    again, _ = told.after(12, [Echo(5, u[5], None)], [])
    assert again == told
    told, _ = told.after(12, [], [InForce(tick, u[tick]) for tick in (0, 1, 3, 4)])
    told, _ = told.after(13, [Echo(8, u[8], None)], [])
    assert (told.missing, told.before.tolist()) == ((6, 7), u[5].tolist())


@settings(max_examples=20)
@given(st.data(), st.sampled_from(["popf", "popf-exact", "delayed-ekf"]))
def test_jitter_losses_repeats_and_disorder_leave_nothing_wrong(data, estimator):
    """Commands get lost, late and out of order; measurements late, out of order and twice. When
    all has been echoed, the inputs are known: without noise the estimate is exact."""
    link = Link(estimator, 3)
    command = st.one_of(st.none(), st.integers(0, 8))
    measurement = st.lists(st.integers(0, 12), min_size=1, max_size=2)
    for delays in data.draw(st.lists(st.tuples(command, measurement), min_size=10, max_size=40)):
        link.tick(*delays)
    for _ in range(40):
        link.tick(3, [0])
    assert link.n == 3
    assert link.error < 1e-9


def test_the_station_reads_the_echoes_from_the_measurements():
    """By wire: commands take 2 ticks, the station believes 0."""
    station = Station(StationConfig(initial_estimate=START, law=LAW, estimator="delayed-ekf"))
    robot, model, receiver = Sender(1, 1), RobotModel(), Receiver()
    pose, force, sent = np.array(START), (np.zeros(2), NO_COMMAND), []
    for k in range(40):
        echo = Measurement(*pose, *force[0], k, force[1])
        answer = b"".join(station.hear(frames_in(robot.frame(echo) + robot.frame(Tick(k, 1)))))
        estimate, command = (frame.message for frame in receiver.receive(answer))
        sent.append((np.array(command.speeds), k))
        if k >= 2:
            force = sent[k - 2]
        if k > 5:
            assert np.abs(np.array(estimate.pose) - pose).max() < 1e-12
        pose = model.f(pose, force[0])
    assert (station.report().n_seen, station.report().m_seen) == (2, 0)
