"""Durations in a histogram: each counts at once, however many are sorted in together."""

import numpy as np
import pytest

from laglab_protocol import Durations
from laglab_protocol.timing import AT_A_TIME


@pytest.mark.parametrize("count", [1, AT_A_TIME - 1, AT_A_TIME, AT_A_TIME + 1, 5 * AT_A_TIME])
def test_they_are_told_to_three_digits(count: int) -> None:
    taken = np.random.default_rng(1).integers(1_000, 10_000_000, count)
    durations = Durations()
    for number, nanoseconds in enumerate(taken.tolist(), start=1):
        durations.add(nanoseconds)
        assert len(durations) == number
    for _ in range(2):  # asked once more, nothing is counted twice
        found = durations.quantiles()
        assert found is not None
        exact = [np.quantile(taken, share, method="inverted_cdf") for share in (0.5, 0.99, 1.0)]
        assert found == pytest.approx([1e-9 * each for each in exact], rel=2e-3)
        assert len(durations) == count


def test_none_and_what_cannot_be() -> None:
    durations = Durations()
    assert durations.quantiles() is None
    durations.add(-5)
    durations.add(10**15)
    found = durations.quantiles()
    assert found is not None
    assert found.longest == pytest.approx(1e6)  # exactly, unlike the others: beyond the hour
