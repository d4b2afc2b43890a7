"""The paper's estimators on a scalar at rest, beside what (8), (11) and (21) to (24) give by hand.

x_{k+1} = x_k, z_k = x_k + v_k, Q = 0, R = 1, P_0 = 1, x^_0 = 0.
"""

from dataclasses import replace

import numpy as np
import pytest

from laglab_control import Ekf, LiteralPopf, Measured, NonlinearModel, Popf, PopfExact
from laglab_control.estimators.paper.raw import Raw

ONE = np.eye(1)


def scalar(h=lambda x: x, H=lambda _x: ONE, a=1.0):
    return NonlinearModel(
        f=lambda x, _u: a * x,
        A=lambda _x, _u: a * ONE,
        W=lambda _x, _u: ONE,
        Q=0 * ONE,
        h=h,
        H=H,
        R=ONE,
    )


AT_REST = scalar()
POPFS = [Popf, LiteralPopf, PopfExact]


def begun(estimator, x=0.0):
    return estimator.start(np.array([x]), ONE)


def run(estimator, *ticks, x=0.0):
    """`ticks`: for each, what is told there, (s, z) each."""
    state = begun(estimator, x)
    for k, told in enumerate(ticks):
        state = estimator.predict(state, np.zeros(1)) if k else state
        state = estimator.correct(state, [Measured(s, np.array([z])) for s, z in told])
    return state


def assert_is(estimator, state, x, P, v=None, S=None):
    assert state.x.tolist() == pytest.approx([x])
    assert state.P.ravel().tolist() == pytest.approx([P])
    innovation = estimator.innovation(state)
    if v is None:
        assert innovation is None
    else:
        assert innovation.value.tolist() == pytest.approx([v])
        assert innovation.S.ravel().tolist() == pytest.approx([S])


@pytest.mark.parametrize("kind", [Ekf, *POPFS])
def test_at_tick_0_it_knows_the_prior_and_takes_what_was_measured_there(kind):
    """(8): K = 1/2."""
    estimator = kind(AT_REST)
    state = begun(estimator)
    assert state.tick == 0
    assert_is(estimator, state, 0.0, 1.0)
    assert_is(estimator, run(estimator, [(0, 3.0)]), 1.5, 0.5, 3.0, 2.0)


@pytest.mark.parametrize("kind", [Ekf, *POPFS])
def test_a_tick_without_a_measurement_has_no_innovation(kind):
    estimator = kind(AT_REST)
    assert_is(estimator, run(estimator, [(0, 3.0)], []), 1.5, 0.5)
    assert run(estimator, [(0, 3.0)], []).tick == 1


@pytest.mark.parametrize("kind", POPFS)
def test_one_that_comes_a_tick_late(kind):
    """(11) with M* = 1 at tick 1, K = 1/2."""
    estimator = kind(AT_REST)
    assert_is(estimator, run(estimator, [], [(0, 3.0)]), 1.5, 0.5, 3.0, 2.0)


@pytest.mark.parametrize("kind", [Popf, LiteralPopf])
@pytest.mark.parametrize("steady", [True, False])
def test_the_next_one_sees_what_was_corrected_meanwhile(kind, steady):
    """z_1 at tick 2: x^-_1 = 0 and P^-_1 = 1, M* (21) = 1 - 1/2, so K = 1/4.

    x = 3/2 + 4/4, P = 1/2 - 1/4 * 1/2. Also when it came at the tick of the other: then M* is what
    is left there.
    """
    estimator = kind(AT_REST)
    ticks = ([], [(0, 3.0)], [(1, 4.0)]) if steady else ([], [], [(1, 4.0), (0, 3.0)])
    assert_is(estimator, run(estimator, *ticks), 2.5, 0.375, 4.0, 2.0)


@pytest.mark.parametrize("kind", [Popf, LiteralPopf])
def test_one_that_comes_after_its_successor_is_used_once(kind):
    """z_1 at tick 2: K = 1/2, x = 4/2, P = 1/2. Then z_0: M* = 1/2 is what tick 2 has left of the
    prior's error, so K = 1/4, x = 2 + 3/4, P = 1/2 - 1/4 * 1/2."""
    estimator = kind(AT_REST)
    state = run(estimator, [], [], [(1, 4.0)], [(0, 3.0)])
    assert_is(estimator, state, 2.75, 0.375, 3.0, 2.0)
    for s in (0, 1):
        assert estimator.correct(state, [Measured(s, np.array([9.0]))]) is state


@pytest.mark.parametrize("steady", [True, False])
def test_the_true_gain_knows_that_both_errors_are_of_one_prior(steady):
    """x~_1+ = (x~_0 + v_0)/2, so E[x~_2 x~^-_1] = 1/2, K = 1/4 and P = 1/2 - 1/4 * 1/2."""
    estimator = PopfExact(AT_REST)
    first = [[], [(0, 3.0)], [(1, 4.0)]] if steady else [[], [], [(1, 4.0), (0, 3.0)]]
    assert_is(estimator, run(estimator, *first), 2.5, 0.375, 4.0, 2.0)


def test_ekf_raw_and_the_true_gain_pass_over_what_is_older_than_the_newest():
    for estimator in (Ekf(AT_REST), PopfExact(AT_REST), Raw()):
        state = run(estimator, [], [], [(2, 1.0)])
        older = [Measured(s, np.array([9.0])) for s in (0, 1, 2)]
        assert estimator.correct(state, older).x == state.x


def test_raw_is_the_newest_measurement_and_claims_nothing():
    raw = Raw()
    assert begun(raw).x is None
    assert begun(raw).P is None
    assert begun(raw).tick == 0
    state = run(raw, [(0, 5.0)], [(1, 7.0), (0, 6.0)], [(1, 8.0)])
    assert state.x.tolist() == [7.0]
    assert state.tick == 2
    assert raw.innovation(state) is None
    assert not raw.is_watchable


def test_popf_printed_takes_another_innovation_than_it_shows():
    """h(x) = x^2 from x^_0 = 1, x doubling: H = 2, S = 5, M* = 2, K = 4/5; z_0 = 2 is 1 more than
    h(x^-_0) = 1 and 2 less than h(x^-_1) = 4. P = 4 - 4/5 * 4, or with H_1 = 4: 4 - 4/5 * 8."""
    doubling = scalar(h=lambda x: x**2, H=lambda x: 2 * np.diag(x), a=2.0)
    for at_k, covariance_at_k in ((False, False), (True, False), (False, True)):
        popf = Popf(doubling, innovation_at_k=at_k, covariance_at_k=covariance_at_k)
        state = run(popf, [], [(0, 2.0)], x=1.0)
        taken, P = (-2.0 if at_k else 1.0), 4.0 - 0.8 * (8.0 if covariance_at_k else 4.0)
        assert_is(popf, state, 2.0 + 0.8 * taken, P, 1.0, 5.0)
    assert Popf(doubling) == Popf(doubling, innovation_at_k=False, covariance_at_k=False)
    literal = LiteralPopf(doubling)
    assert_is(literal, run(literal, [], [(0, 2.0)], x=1.0), 2.8, 0.8, 1.0, 5.0)


def warned(popf, P, m):
    """Of z_1, m ticks late and nothing else."""
    state = popf.start(np.zeros(1), P * ONE)
    for _ in range(m + 1):
        assert popf.warning(state) is None
        state = popf.predict(state, np.zeros(1))
    state = popf.correct(state, [Measured(1, np.ones(1))])
    assert popf.warning(popf.predict(state, np.zeros(1))) is None
    return popf.warning(state)


def test_popf_warns_of_a_gain_above_the_limit_of_its_delay_and_of_no_other():
    """It is 2 sin(pi/14) = 0.445 at m = 3, 1 at m = 1 and 2 at m = 0; K = P_0 / (P_0 + 1)."""
    popf = Popf(AT_REST)
    assert warned(popf, 3.0, 3) == (
        "popf's gain is 0.750; above 0.445 a delay of 3 ticks can make it diverge: take a smaller "
        "P_0, or delayed-ekf"
    )
    assert warned(popf, 0.8, 3) is None
    assert warned(popf, 3.0, 1) is None


def test_popf_with_a_perfect_sensor_and_no_delay_is_not_warned_of():
    """Its gain is 1 then."""
    assert warned(Popf(replace(AT_REST, R=0 * ONE)), 1.0, 0) is None
