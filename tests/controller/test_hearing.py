"""What the robot's messages tell, in ticks that are counted from the station's first."""

from math import inf, nan

from laglab_protocol import Applied, Measurement
from laglab_station.hearing import echoes, recalled


def test_what_was_in_force_is_told_of_ticks_that_are_over() -> None:
    told = Applied((0.5,) * 12, (0.0,) * 12, 95, 12)
    assert [each.tick for each in recalled([told], 90, 100)] == [5, 6, 7, 8, 9]
    assert [each.tick for each in recalled([told], 98, 120)] == list(range(9))


def test_a_measurement_echoes_the_tick_before_it_from_the_first_on() -> None:
    """A command from before the first tick is none of this station's."""
    ticks = ((10, 9), (11, 9), (14, 10), (30, 12))
    told = [Measurement(0.0, 0.0, 0.0, 0.1, 0.2, tick, made) for tick, made in ticks]
    assert [each[::2] for each in echoes(told, 10, 20)] == [(0, None), (3, 0)]


def test_a_measurement_that_does_not_tell_what_was_in_force_echoes_nothing() -> None:
    """The robot is asked for it, as for any that was lost."""
    told = [
        Measurement(0.0, 0.0, 0.0, v, omega, tick, 9)
        for tick, v, omega in ((11, nan, 0.0), (12, 0.0, inf), (13, 0.1, 0.2))
    ]
    assert [each.tick for each in echoes(told, 0, 20)] == [12]
