"""When a robot that is taken over counts as at rest."""

import pytest

from laglab_control import RobotModel
from laglab_protocol import NO_COMMAND, Measurement
from laglab_station.joining import Rest, observe

MODEL = RobotModel()
RESTING = observe(Rest(), Measurement(1.0, 2.0, 0.5, 0.0, 0.0, 5, NO_COMMAND), MODEL)


@pytest.mark.parametrize("speeds", [(0.1, 0.0), (0.0, 0.1), (-0.1, 0.0), (0.0, -0.1)])
def test_a_robot_that_moves_or_turns_is_not_at_rest(speeds: tuple[float, float]) -> None:
    assert RESTING.samples == 1
    moving = Measurement(1.0, 2.0, 0.5, *speeds, 6, NO_COMMAND)
    assert observe(RESTING, moving, MODEL).samples == 0


@pytest.mark.parametrize("tick", [5, 4])
def test_a_repeat_and_what_comes_late_are_not_counted(tick: int) -> None:
    again = Measurement(9.0, 9.0, 0.5, 0.0, 0.0, tick, NO_COMMAND)
    assert observe(RESTING, again, MODEL) is RESTING
