"""Delays on top of the fixed one, as they are drawn."""

from typing import Any

import numpy as np
import pytest

from laglab_gateway import ConfigError, ExtraDelay, Impairments, RandomFates

TS = 0.01


@pytest.mark.parametrize("correlation", [0.0, 0.9])
def test_a_table_of_delays_is_drawn_as_it_is_and_as_it_wanders(correlation: float) -> None:
    quantiles = (0.01, 0.02, 0.05, 0.1)
    table = ExtraDelay("table", 0.005, quantiles=quantiles, correlation=correlation)
    fates = RandomFates(Impairments(extra_delay=table), [], np.random.default_rng(3))
    drawn = np.array([fates.of(k, k * TS, b"x")[0].extra for k in range(20_000)])
    at = np.quantile(drawn, [0.0, 1 / 3, 2 / 3, 1.0])
    np.testing.assert_allclose(at, np.array(quantiles) + 0.005, rtol=0.08)
    ranks = np.argsort(np.argsort(drawn))
    assert np.corrcoef(ranks[1:], ranks[:-1])[0, 1] == pytest.approx(correlation, abs=0.03)


@pytest.mark.parametrize("distribution", ["constant", "uniform", "normal", "exponential"])
def test_delays_that_wander_scatter_as_those_that_do_not(distribution: Any) -> None:
    spread = [
        RandomFates(
            Impairments(extra_delay=ExtraDelay(distribution, 0.04, 0.01, correlation=kept)),
            [],
            np.random.default_rng(5),
        )
        for kept in (0.0, 0.5)
    ]
    drawn = [[each.of(k, 0.0, b"x")[0].extra for k in range(10_000)] for each in spread]
    shares = [0.05, 0.5, 0.95]
    np.testing.assert_allclose(*(np.quantile(each, shares) for each in drawn), rtol=0.1)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"distribution": "table"}, "quantiles: a table has two delays or more"),
        ({"quantiles": (0.2, 0.1)}, "quantiles: must rise from one to the next"),
        ({"correlation": 1.0}, "correlation: must be below 1"),
    ],
)
def test_delays_that_cannot_be_are_refused(values: dict[str, Any], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        ExtraDelay(**values)
