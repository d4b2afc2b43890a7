"""`delayed-ekf` on a scalar, beside what Bayes' rule gives by hand.

x_{k+1} = x_k + u_k, z_k = x_k + v_k, Q = 0, R = 1, P_0 = 1, x^_0 = 0: after n measurements P is
1/(n + 1), and x the mean of 0 and of each z_s less the way driven until s, plus all of that way.
"""

from dataclasses import replace

import numpy as np
import pytest

from laglab_control import DelayedEkf, InForce, Measured, NonlinearModel, ReplayedInputs

ONE = np.eye(1)
SCALAR = NonlinearModel(
    f=lambda x, u: x + u,
    A=lambda _x, _u: ONE,
    W=lambda _x, _u: ONE,
    Q=0 * ONE,
    h=lambda x: x,
    H=lambda _x: ONE,
    R=ONE,
)
EKF = DelayedEkf(SCALAR, ReplayedInputs(SCALAR), memory=4)


def driven(*inputs, start=None):
    """By so much in each tick."""
    state = EKF.start(np.zeros(1), ONE) if start is None else start
    for u in inputs:
        state = EKF.predict(state, np.array([u]))
    return state


def told(state, *measured, inputs=()):
    """(s, z) and (j, u)."""
    measured = [Measured(s, np.array([z])) for s, z in measured]
    return EKF.correct(state, measured, [InForce(j, np.array([u])) for j, u in inputs])


def assert_is(state, x, n, v=None, S=None):
    assert state.x.tolist() == pytest.approx([x])
    assert state.P.ravel().tolist() == pytest.approx([1 / (n + 1)])
    innovation = EKF.innovation(state)
    if v is None:
        assert innovation is None
    else:
        assert innovation.value.tolist() == pytest.approx([v])
        assert innovation.S.ravel().tolist() == pytest.approx([S])


def test_at_tick_0():
    state = driven()
    assert state.tick == 0
    assert_is(state, 0.0, 0)
    assert_is(told(state, (0, 3.0)), 1.5, 1, 3.0, 2.0)
    assert_is(told(told(state, (0, 3.0))), 1.5, 1)


def test_in_order_and_late():
    """z_0 = 3, z_1 = 5 after a way of 1: mean of 0, 3 and 4. v = 5 - (1.5 + 1), S = 1/2 + 1."""
    first = told(driven(1.0, 2.0), (0, 3.0))
    assert_is(first, 1.5 + 3, 1, 3.0, 2.0)
    state = told(first, (1, 5.0))
    assert_is(state, 7 / 3 + 3, 2, 2.5, 1.5)
    assert_is(driven(4.0, start=state), 7 / 3 + 7, 2)


def test_out_of_order_it_shows_what_is_expected_of_the_older_by_now():
    """z_1 came first: of z_0 only the prior was known before, v = 3 and S = 2."""
    state = told(told(driven(1.0, 2.0), (1, 5.0)), (0, 3.0))
    assert_is(state, 7 / 3 + 3, 2, 3.0, 2.0)


def test_of_several_it_shows_the_newest():
    assert_is(told(driven(1.0, 2.0), (1, 5.0), (0, 3.0)), 7 / 3 + 3, 2, 2.5, 1.5)
    behind = told(driven(1.0, 2.0, 0.0), (3, 6.0))
    assert_is(told(behind, (1, 5.0), (0, 3.0)), (3 + 3 + 4) / 4 + 3, 3, 2.5, 1.5)


@pytest.mark.parametrize("s", [0, 1, 2])
def test_of_two_of_one_tick_the_first_is_used(s):
    """Whether the EKF is there, has passed, or is yet to come."""
    state = told(driven(0.0, 0.0, 0.0), (1, 0.0))
    twice = told(state, (s, 4.0), (s, 9.0))
    if s == 1:
        assert_is(twice, 0.0, 1, 0.0, 2.0)
    else:
        assert twice.x.tolist() == pytest.approx([4 / 3])
        assert_is(told(twice, (s, 9.0)), 4 / 3, 2, *((4.0, 2.0) if s == 0 else (4.0, 1.5)))


@pytest.mark.parametrize("j", [0, 1, 2, 3])
def test_an_input_that_was_another_is_put_right_before_and_behind_the_newest(j):
    """z_2 = 5 is the newest; where u_0 or u_1 was 4 more, less of it is left unexplained."""
    state = told(driven(1.0, 1.0, 1.0, 1.0), (2, 5.0))
    assert_is(state, 1.5 + 4, 1, 3.0, 2.0)
    unexplained = 3.0 - (4.0 if j < 2 else 0.0)
    right = told(state, inputs=[(j, 5.0)])
    assert_is(right, unexplained / 2 + 8, 1)
    assert_is(told(right, (2, 0.0)), unexplained / 2 + 8, 1, unexplained, 2.0)
    assert_is(told(state, (3, 9.0), inputs=[(j, 5.0)]), *with_the_next(unexplained, j))
    assert_is(told(right, (3, 9.0)), *with_the_next(unexplained, j))


def with_the_next(unexplained, j):
    """z_3 = 9 beside it: x, n, v and S."""
    way = 3.0 + (4.0 if j < 3 else 0.0)
    v = 9.0 - way - unexplained / 2
    return (unexplained + 9.0 - way) / 3 + 8, 2, v, 1.5


def test_inputs_before_and_behind_the_newest_at_once():
    state = told(driven(1.0, 1.0, 1.0, 1.0), (2, 5.0))
    right = told(state, inputs=[(0, 2.0), (1, 3.0), (2, 4.0), (3, 5.0)])
    assert_is(right, 0.0 + 14, 1)
    assert_is(told(right, (4, 14.0)), 14.0, 2, 0.0, 1.5)


def test_an_input_and_a_measurement_that_come_together_whichever_is_older():
    state = told(driven(1.0, 1.0, 1.0, 1.0), (3, 6.0))
    for s, j in ((1, 2), (2, 0), (2, 1), (1, 0), (0, 3), (3, 1)):
        together = told(state, (s, 5.0), inputs=[(j, 5.0)])
        one_by_one = told(told(state, inputs=[(j, 5.0)]), (s, 5.0))
        other_way = told(told(state, (s, 5.0)), inputs=[(j, 5.0)])
        assert together.x.tolist() == pytest.approx(one_by_one.x.tolist())
        assert together.x.tolist() == pytest.approx(other_way.x.tolist())
        first = 6.0 - 3 - (4 if j < 3 else 0)
        second = 0.0 if s == 3 else 5.0 - s - (4 if j < s else 0)
        assert_is(other_way, (first + second) / (2 if s == 3 else 3) + 8, 1 if s == 3 else 2)


def test_what_it_no_longer_keeps_has_no_innovation():
    """Of a log of at most 2 * 4 ticks; what it keeps but does not use has none either."""
    state = told(driven(*[0.0] * 20), (20, 4.0))
    assert state.filtered.length < 20
    for s in range(20 - 4):
        assert_is(told(state, (s, 9.0)), 2.0, 1)
    assert_is(told(state, (16, 9.0)), 13 / 3, 2, 9.0, 2.0)


@pytest.mark.parametrize("s", [0, 1, 3])
def test_it_goes_through_no_more_of_the_past_than_follows_the_measurement(s):
    """The EKF is at tick 4: it predicts s to 4 again, and tick 0 never."""
    gone = []

    def f(x, u):
        gone.append(x)
        return x + u

    model = replace(SCALAR, f=f)
    ekf = DelayedEkf(model, ReplayedInputs(model))
    state = ekf.start(np.zeros(1), ONE)
    for _ in range(5):
        state = ekf.predict(state, np.ones(1))
    state = ekf.correct(state, [Measured(4, np.ones(1))])
    gone.clear()
    state = ekf.correct(state, [Measured(s, np.ones(1))])
    assert len(gone) == 4 - max(s - 1, 0)
    gone.clear()
    ekf.correct(state, [], [InForce(-1, np.ones(1))])
    assert gone == []
