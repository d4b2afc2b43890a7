"""Which command the robot follows, and when it stops by itself."""

from itertools import pairwise

import pytest

from laglab_gateway.drive import (
    Drive,
    Mode,
    Rejection,
    Safety,
    follow,
    rejection,
    speeds,
    supervise,
)
from laglab_protocol import Command

TS = 0.01
SAFETY = Safety(v_limit=2.0, omega_limit=3.0, link_timeout=0.5, ramp=0.4)


def command(tick: int, v: float = 1.0, omega: float = -0.5) -> Command:
    return Command(v, omega, tick, 1, 1, 0)


@pytest.mark.parametrize(
    ("bad", "why"),
    [
        (command(9, v=float("nan")), Rejection.NOT_FINITE),
        (command(9, omega=float("inf")), Rejection.NOT_FINITE),
        (command(9, v=2.1), Rejection.OUT_OF_LIMITS),
        (command(9, omega=-3.1), Rejection.OUT_OF_LIMITS),
        (command(7), Rejection.STALE),
        (command(8), Rejection.STALE),
        (command(9), None),
    ],
)
def test_what_is_refused(bad: Command, why: Rejection | None) -> None:
    assert rejection(follow(command(8), tick=10), bad, SAFETY) is why


@pytest.mark.parametrize("speed", ["v", "omega"])
def test_without_limits_too_nothing_drives_so_fast_that_the_wheels_overflow(speed: str) -> None:
    assert rejection(Drive(), command(0, **{speed: 1e5}), Safety()) is None
    assert rejection(Drive(), command(0, **{speed: 3e307}), Safety()) is Rejection.OUT_OF_LIMITS


def test_it_stands_still_until_the_first_command() -> None:
    drive = supervise(Drive(), 1000, TS, SAFETY)
    assert drive.mode is Mode.WAITING
    assert speeds(drive, 1000, TS, SAFETY) == (0.0, 0.0)


def test_without_fresh_commands_it_ramps_to_a_stop() -> None:
    drive = follow(command(8), tick=10)
    assert supervise(drive, 59, TS, SAFETY).mode is Mode.DRIVING
    drive = supervise(drive, 60, TS, SAFETY)
    assert drive.mode is Mode.STOPPING
    ramp = [speeds(drive, tick, TS, SAFETY) for tick in range(60, 120)]
    assert ramp[0] == (1.0, -0.5)
    assert ramp[20] == pytest.approx((0.5, -0.25))
    assert ramp[40:] == [(0.0, -0.0)] * 20
    assert all(later[0] <= earlier[0] for earlier, later in pairwise(ramp))


def test_only_a_fresh_command_moves_it_again() -> None:
    drive = supervise(follow(command(8), tick=10), 60, TS, SAFETY)
    assert rejection(drive, command(8), SAFETY) is Rejection.STALE
    drive = follow(command(55), tick=65)
    assert (drive.mode, speeds(drive, 65, TS, SAFETY)) == (Mode.DRIVING, (1.0, -0.5))
