"""A robot that stands whatever it is sent: when it is believed, and until when."""

import numpy as np
import pytest

from laglab_control import Echo, InForce, RobotModel
from laglab_control.flight import FEW, STOOD, Flight, Told, believed_sum, hear, send, take_off
from laglab_control.laws.interface import STAND
from laglab_control.model import Vector
from laglab_control.motion import NOWHERE

MODEL = RobotModel()
N, M = 3, 2
DRIVE = np.array((0.5, 0.2))
FROM = 40
"""The robot stands from this tick on."""
BELIEVED = FROM + STOOD + N
"""The tick by whose echo it is believed."""


def sent(ticks: int, first: int = 0) -> Flight:
    """DRIVE is sent from tick `first` on."""
    flight = take_off(MODEL, N)
    for k in range(ticks):
        flight, _ = send(MODEL, flight, DRIVE if k >= first else STAND)
    return flight


def ticks_until_believed(drives: range, first: int = 0) -> int | None:
    """By the echo of which tick the robot is believed to stand, if it drives only at some."""
    flight = take_off(MODEL, N)
    for k in range(200):
        flight, _ = send(MODEL, flight, DRIVE if k >= first else STAND)
        flight, _ = told(flight, k - M, k - M in drives)
        if flight.stands:
            return k - M
    return None


def told(flight: Flight, tick: int, drives: bool) -> tuple[Flight, list[InForce]]:
    if tick < 0:
        return flight, []
    echo = Echo(tick, DRIVE, tick - N) if drives else Echo(tick, STAND, None)
    return hear(MODEL, flight, [echo])


def standing() -> Flight:
    """One that has just come to be believed to stand."""
    flight = sent(M)
    for tick in range(BELIEVED + 1):
        flight, _ = send(MODEL, flight, DRIVE)
        flight, inputs = told(flight, tick, N <= tick < FROM)
    assert [each.tick for each in inputs] == [BELIEVED, BELIEVED + 1, BELIEVED + 2]
    assert all(each.u.tolist() == [0.0, 0.0] for each in inputs)
    return flight


def test_it_is_believed_when_it_has_stood_for_longer_than_it_rests_after_a_silence() -> None:
    assert ticks_until_believed(range(N, FROM)) == BELIEVED


def test_it_is_believed_where_it_was_to_drive_all_the_while() -> None:
    assert ticks_until_believed(range(0), first=50) == 50 + N + STOOD
    assert ticks_until_believed(range(0), first=200) is None


def test_what_is_sent_to_it_is_then_believed_to_be_in_vain() -> None:
    flight = standing()
    for _ in range(3):
        assert flight.stands
        assert flight.ahead == NOWHERE
        assert [u.tolist() for u in flight.in_flight] == [[0.0, 0.0]] * N
        assert believed_sum(flight, 0) == (0.0, 0.0)
        flight, applied = send(MODEL, flight, DRIVE)
        assert applied.tolist() == [0.0, 0.0]


def drives(flight: Flight) -> bool:
    return not flight.stands and [u.tolist() for u in flight.in_flight] == [DRIVE.tolist()] * N


def test_when_it_drives_again_so_does_all_that_is_on_its_way() -> None:
    flight, inputs = told(standing(), BELIEVED + 1, drives=True)
    assert drives(flight)
    assert flight.ahead == sent(50).ahead
    assert [(each.tick, each.u.tolist()) for each in inputs] == [
        (BELIEVED + 1, DRIVE.tolist()),
        (BELIEVED + 2, DRIVE.tolist()),
    ]


def test_when_nobody_tells_for_long_it_may_drive_again() -> None:
    flight = standing()
    for _ in range(FEW + 1):
        flight, _ = send(MODEL, flight, DRIVE)
        assert flight.stands
    flight, applied = send(MODEL, flight, DRIVE)
    assert drives(flight)
    assert applied.tolist() == DRIVE.tolist()


@pytest.mark.parametrize(
    ("gap", "u", "stood"),
    [(1, STAND, 6), (FEW, STAND, 5 + FEW), (FEW + 1, STAND, 1), (1, DRIVE, 0)],
)
def test_over_a_long_gap_nobody_knows_whether_it_stood(gap: int, u: Vector, stood: int) -> None:
    echo = Echo(10 + gap, u, None)
    assert Told(known=10, stood=5).after(40, [echo], [])[0].stood == stood


def test_it_must_have_stood_for_longer_than_a_command_takes_besides() -> None:
    assert not Told(stood=STOOD + 7).has_stood(7)
    assert Told(stood=STOOD + 8).has_stood(7)
