"""Telemetry comes as often as it should."""

from collections.abc import Iterable

import numpy as np
import pytest

from laglab_gateway import Services
from laglab_gateway.services import Asker, Pace
from laglab_protocol import (
    CommandAck,
)
from laglab_protocol.dialect.generated import laglab as mavlink

from .asking import STATE, command, frame, result


def reports(pace: Pace, number: int, times: Iterable[int]) -> int:
    return [number for now in times for number in pace.due(now)].count(number)


HEARTBEAT, POSITION, ODOMETRY = 0, 32, 331


def test_telemetry_comes_as_often_as_it_should() -> None:
    ten_seconds = range(20_000_000, 30_000_000, 20_000)

    assert reports(Pace(), HEARTBEAT, ten_seconds) == 10
    assert reports(Pace(), POSITION, ten_seconds) == 100


@pytest.mark.parametrize("per_second", [10, 50])
def test_looked_for_late_it_comes_as_often_all_the_same(per_second: int) -> None:
    """At uneven times up to a tick and a half apart."""
    times = np.cumsum(np.random.default_rng(1).integers(5_000, 15_000, 1000)).tolist()
    pace = Pace()
    pace.set(ODOMETRY, 1e6 / per_second)

    assert reports(pace, ODOMETRY, times) == pytest.approx(per_second * times[-1] * 1e-6, abs=2)


def test_after_a_pause_little_is_made_up_for() -> None:
    pace = Pace()
    pace.due(0)

    assert reports(pace, POSITION, range(10_000_000, 10_050_000, 1_000)) <= 2


@pytest.mark.parametrize(("interval", "count"), [(500_000.0, 20), (-1.0, 0), (0.0, 100)])
def test_the_pace_can_be_set(services: Services, interval: float, count: int) -> None:
    asker = Asker(pace=Pace())
    (ack,) = services.answer(frame(command(511, ODOMETRY, interval)), STATE, asker)

    assert isinstance(ack, CommandAck)
    assert ack.result == mavlink.MAV_RESULT_ACCEPTED
    assert asker.pace is not None
    assert reports(asker.pace, ODOMETRY, range(0, 10_000_000, 20_000)) == count


def test_who_is_sent_no_telemetry_has_no_pace_to_set(services: Services) -> None:
    assert result(services, 511, ODOMETRY, 1e6) == mavlink.MAV_RESULT_UNSUPPORTED
