"""What is claimed for inputs that are only believed."""

import numpy as np
import pytest

from laglab_control import Echo, InForce, RobotModel
from laglab_control.doubt import PATIENCE, doubt
from laglab_control.flight import Flight, hear, send, take_off
from laglab_control.model import Matrix, Vector

MODEL = RobotModel()
Ts = MODEL.sample_time
N, M = 3, 5
X = np.array((1.0, 2.0, 0.5))


def told(flight: Flight, tick: int, u: Vector, late: int = N) -> Flight:
    return hear(MODEL, flight, [Echo(tick, u, tick - late)])[0]


def flown(inputs: list[Vector], lates: list[int] | None = None, silent: int = 0) -> Flight:
    """Each input sent, each in force N ticks later (or as `lates` tell), each echo M ticks late;
    the last `silent` echoes do not come."""
    flight = take_off(MODEL, N)
    for k, u in enumerate(inputs):
        flight, _ = send(MODEL, flight, u)
        s = k + 1 - M
        late = N if lates is None else lates[k % len(lates)]
        if 0 <= s < late:
            flight = hear(MODEL, flight, [Echo(s, np.zeros(2), None)])[0]
        if s >= late and k < len(inputs) - silent:
            flight = told(flight, s, inputs[s - late], late)
    return flight


STEADY = [np.array((0.5, 0.2))] * 60
TURNING = [np.array((0.5, 0.02 * k)) for k in range(60)]


def test_while_all_is_as_it_usually_is_there_is_none() -> None:
    assert doubt(flown(TURNING), MODEL, X) is None
    assert doubt(take_off(MODEL, N), MODEL, X) is None


def test_before_the_first_echo_there_is_nothing_to_compare_with() -> None:
    flight = take_off(MODEL, N)
    for u in TURNING:
        flight, _ = send(MODEL, flight, u)
    assert doubt(flight, MODEL, X) is None


def test_of_equal_inputs_it_makes_no_difference_when_they_come() -> None:
    unknown = doubt(flown(STEADY, lates=[3] * 5 + [4] * 5), MODEL, X)
    assert unknown is not None
    np.testing.assert_allclose(unknown, 0.0, atol=1e-18)


def test_delays_that_scatter_by_a_tick_shift_a_turn_by_a_tick() -> None:
    flight = flown(TURNING, lates=[3] * 5 + [4] * 5)
    unknown = doubt(flight, MODEL, X)
    assert unknown is not None
    believed = flight.tick - 1 - flight.told.known
    spread = np.std(flight.told.recent)
    expected = Ts * spread * 0.02 * believed
    assert np.sqrt(unknown[2, 2]) == pytest.approx(expected, rel=0.4)


@pytest.mark.parametrize("silent", [PATIENCE + 1, 30])
def test_when_the_echoes_stop_the_last_input_may_have_been_held(silent: int) -> None:
    flight = flown(TURNING, silent=silent)
    unknown = doubt(flight, MODEL, np.zeros(3))
    assert unknown is not None
    believed = [flight.tick - 1 - i for i in range(flight.tick - 1 - flight.told.known)]
    held = flight.told.in_force[1]
    turn = Ts * sum(TURNING[tick - N][1] - held for tick in believed)
    assert np.sqrt(unknown[2, 2]) == pytest.approx(turn)
    assert np.linalg.eigvalsh(unknown)[0] > -1e-15


def test_who_turned_on_the_way_is_aside_by_half_of_it() -> None:
    """Straight on as long as anything is known, then believed to turn; perhaps held straight."""
    straight, turning = np.array((1.0, 0.0)), np.array((1.0, 0.5))
    flight = take_off(MODEL, 0)
    for k in range(60):
        flight, _ = send(MODEL, flight, straight if k < 20 else turning)
        if k < 20:
            flight = told(flight, k, straight, late=0)
    unknown = doubt(flight, MODEL, np.zeros(3))
    assert unknown is not None
    way, turn = 40 * Ts * 1.0, 40 * Ts * 0.5
    assert unknown[2, 2] == pytest.approx(turn**2)
    assert unknown[1, 1] == pytest.approx((way / 2 * turn) ** 2)


def test_a_few_ticks_of_silence_are_nothing_unusual() -> None:
    assert doubt(flown(TURNING, silent=PATIENCE), MODEL, X) is None


def test_after_half_a_second_it_may_stand() -> None:
    flight = flown([np.array((1.0, 0.0))] * 200, silent=100)
    unknown = doubt(flight, MODEL, np.array((0.0, 0.0, np.pi / 2)))
    assert unknown is not None
    assert np.sqrt(unknown[1, 1]) == pytest.approx(0.5, abs=0.05)
    assert unknown[0, 0] < 1e-12


def test_of_ticks_that_were_lost_too_until_the_robot_tells() -> None:
    flight = flown(TURNING, silent=20)
    flight = told(flight, flight.tick - M, TURNING[flight.tick - M - N])
    assert len(flight.told.missing) > 10
    assert doubt(flight, MODEL, X) is not None
    recalled = [InForce(tick, TURNING[tick - N]) for tick in flight.told.missing]
    flight, _ = hear(MODEL, flight, [], recalled)
    assert flight.told.missing == ()
    assert doubt(flight, MODEL, X) is None


def of(*missed: tuple[float, float, float]) -> Matrix:
    """The sum of d d^T, each d of what is missed: forward, turned, and the way over which, in m
    and rad; turned by the heading of X."""
    total = np.zeros((3, 3))
    heading = X[2]
    c, s = np.cos(heading), np.sin(heading)
    for distance, turn, length in missed:
        d = np.array([[c, -s], [s, c]]) @ (distance, length * turn / 2)
        total += np.outer((*d, turn), (*d, turn))
    return total


CURVED = [np.array((0.5 + 0.01 * k, 0.02 * k)) for k in range(160)]


def in_force(ticks: range) -> Matrix:
    """v and omega of CURVED there, N ticks later than sent (ticks, 2)."""
    return np.array([CURVED[tick - N] for tick in ticks])


def test_scattered_delays_count_by_their_deviation() -> None:
    flight = flown(CURVED, lates=[3] * 5 + [4] * 5)
    told, spread = flight.told, np.std(flight.told.recent)
    n = flight.command_delay
    v, omega = CURVED[flight.tick - 1 - n] - told.in_force
    length = Ts * (flight.tick - 1 - told.known) * CURVED[flight.tick - 1 - n][0]
    expected = of((Ts * spread * v, Ts * spread * omega, length))
    assert told.missing == ()
    np.testing.assert_allclose(doubt(flight, MODEL, X), expected, rtol=1e-9)


@pytest.mark.parametrize("silent", [PATIENCE + 1, 60])
def test_in_silence_it_may_have_held_the_last_input_or_stopped(silent: int) -> None:
    """By itself after half a second, of which so far perhaps nothing is over."""
    flight = flown(CURVED, silent=silent)
    known, last = flight.told.known, flight.tick
    believed = in_force(range(known + 1, last))
    v, omega = Ts * (believed - in_force(range(known, known + 1))).sum(axis=0)
    held = (v, omega, Ts * believed[:, 0].sum())
    v, omega = Ts * believed[50:].sum(axis=0)
    np.testing.assert_allclose(doubt(flight, MODEL, X), of(held, (v, omega, v)), rtol=1e-9)


def test_of_what_was_not_told_the_last_input_before_may_have_been_held() -> None:
    flight = flown(CURVED, silent=20)
    before, v = flight.told.known, flight.told.in_force[0]
    flight = told(flight, flight.tick - M, CURVED[flight.tick - M - N])
    lost = range(before + 1, flight.tick - M)
    assert flight.told.missing == tuple(lost)
    distance, turn = Ts * (in_force(lost) - in_force(range(before, before + 1))).sum(axis=0)
    expected = of((distance, turn, Ts * len(lost) * v))
    np.testing.assert_allclose(doubt(flight, MODEL, X), expected, rtol=1e-9)


def test_where_nothing_is_only_believed_scattered_delays_make_no_difference() -> None:
    flight = flown(CURVED, lates=[3] * 5 + [4] * 5)
    tick = flight.tick - 1
    flight, _ = hear(
        MODEL, flight, [Echo(t, CURVED[t - N], t - N) for t in range(tick - M, tick + 1)]
    )
    assert flight.told.spread > 0
    np.testing.assert_array_equal(doubt(flight, MODEL, X), np.zeros((3, 3)))
