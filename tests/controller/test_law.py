import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_control import Demand, Law

coordinate = st.floats(-10, 10)
poses = st.tuples(coordinate, coordinate, coordinate).map(np.array)


def test_equations_2_and_4_worked_by_hand():
    # rho = 2, psi = pi/2, alpha = pi/2 - pi/3 = pi/6, phi = psi - 0 = pi/2
    alpha, phi = math.pi / 6, math.pi / 2
    v, omega, at_goal = Law().drive(np.array([0.0, -2.0, math.pi / 3]), at_goal=False)
    assert v == pytest.approx(3 * 2 * math.sqrt(3) / 2)
    assert omega == pytest.approx(
        6 * alpha + 3 * (math.sqrt(3) / 2) * 0.5 / alpha * (alpha + 1 * phi)
    )
    assert not at_goal


def test_straight_ahead_the_sinc_is_1():
    v, omega, _ = Law(goal=(1.0, 0.0, -0.5)).drive(np.zeros(3), at_goal=False)
    assert (v, omega) == (3.0, pytest.approx(3 * 1 * 0.5))


@given(poses, st.booleans())
def test_limits_clamp_and_nothing_else_changes(pose, at_goal):
    free = Law().drive(pose, at_goal)
    limited = Law(v_max=1.0, omega_max=1.7).drive(pose, at_goal)
    assert limited == Demand(
        min(max(free.v, -1.0), 1.0), min(max(free.omega, -1.7), 1.7), free.at_goal
    )


@pytest.mark.parametrize(
    ("distance", "was_at_goal", "holds"),
    [(0.029, False, True), (0.031, False, False), (0.059, True, True), (0.061, True, False)],
)
def test_goal_tolerance_is_entered_at_one_distance_and_left_at_twice(distance, was_at_goal, holds):
    law = Law(goal=(1.0, 1.0, 0.2), goal_tolerance=0.03)
    drive = law.drive(np.array([1.0 - distance, 1.0, 0.5]), was_at_goal)
    assert drive.at_goal is holds
    if holds:
        assert (drive.v, drive.omega) == (0.0, pytest.approx(6 / 2 * (0.2 - 0.5)))


def test_at_the_goal_the_shorter_way_round_is_turned():
    law = Law(goal_tolerance=0.03, omega_max=1.7)
    assert law.drive(np.array([0.0, 0.0, math.pi + 0.1]), at_goal=False).omega == 1.7
