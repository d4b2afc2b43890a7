"""Losses are fitted: what is lost by known numbers gives them back."""

import numpy as np
import pytest

from laglab.link.fitting import fit_losses
from laglab_gateway import Burst, FateKind, Impairments, RandomFates


def test_a_link_that_is_bad_a_third_of_the_time_is_found_to_be() -> None:
    told = Burst(good_to_bad=0.1, bad_to_good=0.2, loss_good=0.0, loss_bad=0.7)
    fates = RandomFates(Impairments(burst=told), (), np.random.default_rng(3))
    came = [fates.of(k, k * 0.01, b"")[0].kind is FateKind.DELIVERED for k in range(100_000)]
    found = fit_losses(~np.array(came)).burst
    assert found is not None
    assert found.good_to_bad == pytest.approx(0.1, rel=0.15)
    assert found.bad_to_good == pytest.approx(0.2, rel=0.15)
    assert found.loss_bad == pytest.approx(0.7, rel=0.1)
