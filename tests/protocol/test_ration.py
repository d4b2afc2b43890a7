"""A ration fills up with time, and what was taken too much is owed."""

import pytest

from laglab_protocol import Ration


def test_what_was_taken_too_much_is_made_up_for() -> None:
    ration = Ration(10.0, 5.0)
    assert ration.left(0.0) == 5.0
    ration.take(25.0)
    left = [ration.left(now) for now in (0.5, 1.9, 2.3, 9.0)]
    assert left == pytest.approx([-15.0, -1.0, 3.0, 5.0])


def test_whatever_is_done_costs_the_least() -> None:
    ration = Ration(10.0, 5.0, least=2.0)
    ration.left(0.0)
    ration.take(0.5)
    assert ration.left(0.0) == 3.0
