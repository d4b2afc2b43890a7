"""The polar law, and the seam at which every law stands."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_control import Controller, Demand, Measured, PolarLaw, SpeedLimits, StationConfig

coordinate = st.floats(-10, 10)
speed = st.floats(-10, 10)
demands = st.builds(Demand, speed, speed, st.booleans())
LAST = Demand(0.5, -0.5)


def test_equations_2_and_4_worked_by_hand():
    # rho = 2, psi = pi/2, alpha = pi/2 - pi/3 = pi/6, phi = psi - 0 = pi/2
    alpha, phi = math.pi / 6, math.pi / 2
    v, omega, at_goal = PolarLaw().drive(np.array([0.0, -2.0, math.pi / 3]), 0.0, None)
    assert v == pytest.approx(3 * 2 * math.sqrt(3) / 2)
    assert omega == pytest.approx(
        6 * alpha + 3 * (math.sqrt(3) / 2) * 0.5 / alpha * (alpha + 1 * phi)
    )
    assert not at_goal


def test_straight_ahead_the_sinc_is_1():
    v, omega, _ = PolarLaw(goal=(1.0, 0.0, -0.5)).drive(np.zeros(3), 0.0, None)
    assert (v, omega) == (3.0, pytest.approx(3 * 1 * 0.5))


@pytest.mark.parametrize(
    ("distance", "was_at_goal", "holds"),
    [(0.029, False, True), (0.031, None, False), (0.059, True, True), (0.061, True, False)],
)
def test_goal_tolerance_is_entered_at_one_distance_and_left_at_twice(distance, was_at_goal, holds):
    law = PolarLaw(goal=(1.0, 1.0, 0.2), goal_tolerance=0.03)
    v, omega, at_goal = law.drive((1.0 - distance, 1.0, 0.5), 0.0, was_at_goal)
    assert at_goal is holds
    if holds:
        assert (v, omega) == (0.0, pytest.approx(6 / 2 * (0.2 - 0.5)))


@pytest.mark.parametrize(("distance", "was_at_goal"), [(0.25, False), (0.5, True)])
def test_at_the_very_edge_of_the_tolerance_all_stays_as_it_was(distance, was_at_goal):
    law = PolarLaw(goal_tolerance=0.25)
    assert law.drive((distance, 0.0, 0.0), 0.0, was_at_goal).memory is was_at_goal


def test_at_the_goal_the_shorter_way_round_is_turned():
    law = PolarLaw(goal_tolerance=0.03)
    turned = law.drive((0.0, 0.0, math.pi + 0.1), 0.0, None).omega
    assert turned == pytest.approx(3 * (math.pi - 0.1))


@given(demands)
def test_limits_clamp_and_nothing_else_changes(asked):
    sent = SpeedLimits(v_max=1.0, omega_max=1.7).limited(asked, None, LAST, 0.01)
    assert sent == Demand(
        min(max(asked.v, -1.0), 1.0), min(max(asked.omega, -1.7), 1.7), asked.memory
    )
    assert SpeedLimits().limited(asked, np.eye(3), LAST, 0.01) == asked


def test_where_the_pose_is_not_known_well_the_robot_drives_the_more_slowly():
    cautious = SpeedLimits(caution=0.1)
    for deviation, share in ((0.05, 1.0), (0.1, 1.0), (0.4, 0.25)):
        P = np.diag([deviation**2, 1e-6, 1.0])
        sent = cautious.limited(Demand(1.0, -2.0, "kept"), P, LAST, 0.01)
        assert sent == (pytest.approx(share), pytest.approx(-2 * share), "kept")
    assert cautious.limited(Demand(1.0, -2.0), None, LAST, 0.01) == Demand(1.0, -2.0)


@pytest.mark.parametrize("axis", [0, 1])
def test_the_less_sure_of_x_and_y_makes_it_slow(axis):
    P = np.diag((1e-4, 1e-4, 1.0))
    P[axis, axis] = 0.04
    sent = SpeedLimits(caution=0.1).limited(Demand(1.0, 0.5), P, LAST, 0.01)
    assert (sent.v, sent.omega) == pytest.approx((0.5, 0.25))


@given(demands, demands)
def test_limits_on_acceleration_hold_between_one_command_and_the_next(asked, last):
    limits = SpeedLimits(v_max=1.0, accel_max=2.0, alpha_max=30.0)
    v, omega, _ = limits.limited(asked, None, last, 0.01)
    assert abs(v - last.v) <= 0.02 + 1e-9
    assert abs(omega - last.omega) <= 0.3 + 1e-9
    wanted = min(max(asked.v, -1.0), 1.0)
    assert min(last.v, wanted) - 1e-9 <= v <= max(last.v, wanted) + 1e-9


@pytest.mark.parametrize(
    ("last", "asked", "sent"),
    [(1.0, 3.0, 1.5), (1.0, -3.0, 0.5), (-1.0, -3.0, -1.5), (-1.0, 3.0, -0.5), (1.0, 1.25, 1.25)],
)
def test_towards_what_is_asked_it_goes_by_what_a_tick_allows(last, asked, sent):
    limits = SpeedLimits(accel_max=5.0, alpha_max=5.0)
    assert limits.limited(Demand(asked, 7.0), None, Demand(last, 7.0), 0.1) == Demand(sent, 7.0)
    assert limits.limited(Demand(7.0, asked), None, Demand(7.0, last), 0.1) == Demand(7.0, sent)


class Counting:
    """A law of somebody's own, which counts and writes down what it was asked."""

    def __init__(self):
        self.asked = []

    def drive(self, pose, time, memory):
        count = 0 if memory is None else memory + 1
        self.asked.append((tuple(pose), time, memory))
        return 1.0, 5.0, count


def test_any_law_is_asked_for_the_moment_the_command_comes_into_force():
    law = Counting()
    config = StationConfig(
        law=law, limits=SpeedLimits(omega_max=2.0, accel_max=10.0), command_delay=3, first_tick=100
    )
    controller, pose = Controller(config), np.zeros(3)
    control = controller.answer(controller.start(), [])
    sent = [control.drive]
    for k in range(1, 6):
        control = controller.answer(controller.advance(control), [Measured(k, pose)])
        sent.append(control.drive)
        pose = config.model.f(pose, np.array(sent[k - 3][:2]) if k >= 3 else np.zeros(2))
    poses, times, memories = zip(*law.asked, strict=True)
    assert times == pytest.approx([1.03, 1.04, 1.05, 1.06, 1.07, 1.08])
    assert memories == (None, 0, 1, 2, 3, 4)
    assert [demand.v for demand in sent] == pytest.approx([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    assert {demand.omega for demand in sent} == {2.0}
    moved = np.zeros(3)
    for demand in sent[:2]:  # where the two sent before the third lead
        moved = config.model.f(moved, np.array(demand[:2]))
    assert poses[2] == pytest.approx(moved)
