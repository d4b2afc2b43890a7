"""The loop's delay margin: against the roots themselves, and against the robot."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_control import ConfigError, PolarLaw, RobotModel, delay_margin, wrap

gains = st.floats(0.5, 12)
laws = st.builds(PolarLaw, lambda_=gains, gamma=st.floats(0.5, 6), h=st.floats(0.2, 4))


def largest_root(law: PolarLaw, sample_time: float, delay: int) -> float:
    """Of the linearised approach; infinite where the robot runs past its goal."""
    distance = np.zeros(delay + 2)
    distance[:2] += 1, -1
    distance[-1] += law.gamma * sample_time
    real = [root.real for root in np.roots(distance) if abs(root.imag) < 1e-9 and root.real > 0]
    if not real:
        return math.inf
    s = 1 / max(real) - 1
    heading = np.zeros(delay + 3)
    heading[:3] += np.convolve([1, -1], [1, -1 - s])
    heading[-2:] += sample_time * (law.lambda_ + law.gamma) * np.array([1, -1])
    heading[-1] += sample_time * law.gamma * law.h * s
    return float(abs(np.roots(heading)).max())


@given(laws, st.sampled_from([0.005, 0.01, 0.03]))
def test_the_approach_is_stable_up_to_its_margin_and_not_one_tick_further(law, sample_time):
    margin = delay_margin(law, sample_time).approach
    if margin >= 0:
        assert largest_root(law, sample_time, margin) < 1
    assert largest_root(law, sample_time, margin + 1) > 1 - 1e-9


def swing(law: PolarLaw, delay: int, start: tuple[float, float, float], ticks: int) -> float:
    """The largest |theta| of the last second, with commands `delay` ticks late and nothing else."""
    robot, pose, at_goal = RobotModel(), np.array(start), False
    sent, headings = [np.zeros(2)] * delay, []
    for _ in range(ticks):
        v, omega, at_goal = law.drive(pose, 0.0, at_goal)
        sent.append(np.array((v, omega)))
        pose = robot.f(pose, sent.pop(0))
        headings.append(abs(wrap(pose[2])))
    return max(headings[-100:])


@pytest.mark.parametrize(
    ("law", "margin"),
    [(PolarLaw(), 9), (PolarLaw(h=3.0), 7), (PolarLaw(lambda_=3.0, gamma=1.5), 19)],
)
def test_the_robot_agrees_to_the_tick(law, margin):
    assert delay_margin(law, 0.01) == (margin, None)
    start = (-3.0, -3.0, 0.0)
    assert swing(law, margin, start, ticks=1500) < 0.01
    assert swing(law, margin + 1, start, ticks=1500) > 0.1


def test_the_turn_at_the_goal_agrees_to_the_tick():
    law = PolarLaw(goal_tolerance=0.03)
    hold = delay_margin(law, 0.01).hold
    assert hold == 51
    turned = [swing(law, d, (0.0, 0.0, 0.1), 20_000) for d in (hold, hold + 1)]
    assert turned[0] < 0.1 < turned[1]


def test_a_fine_clock_leaves_the_margin_of_continuous_time():
    assert delay_margin(PolarLaw(), 1e-4).approach * 1e-4 == pytest.approx(0.102, abs=5e-4)


def test_a_clock_that_is_too_slow_bears_no_delay_at_all():
    assert delay_margin(PolarLaw(goal_tolerance=0.03), 1.0) == (-1, -1)
    with pytest.raises(ConfigError, match="sample_time"):
        delay_margin(PolarLaw(), 0.0)
