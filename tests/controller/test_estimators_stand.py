"""What an estimator is made of, and what it knows at a tick, never changes: it may be shared."""

from dataclasses import FrozenInstanceError, fields

import numpy as np
import pytest

from laglab_control import (
    CalibratingEkf,
    DelayedEkf,
    Ekf,
    LiteralPopf,
    Popf,
    PopfExact,
    ReplayedInputs,
    RigidMotions,
    RobotModel,
    TuePredictor,
    WheelScales,
)
from laglab_control.estimators.calibrating.calibrated import CalibratedMotions, CalibratedRobot
from laglab_control.estimators.delayed.rewinding import Rewinding

ROBOT = RobotModel()
SCALES = WheelScales(ROBOT.track)
PRIOR = np.zeros(3), np.eye(3)
HOLDING_ARRAYS = [
    lambda: DelayedEkf(ROBOT, RigidMotions(ROBOT)).start(*PRIOR),
    lambda: CalibratedMotions(ROBOT, SCALES, [0.0, 0.0]),
    lambda: CalibratedRobot(ROBOT, SCALES),
    lambda: CalibratingEkf(ROBOT, SCALES),
]
OTHERS = [
    lambda: SCALES,
    lambda: RigidMotions(ROBOT),
    lambda: ReplayedInputs(ROBOT),
    lambda: DelayedEkf(ROBOT, RigidMotions(ROBOT)),
    lambda: Rewinding(Ekf(ROBOT)),
    *(lambda kind=kind: kind(ROBOT) for kind in (Ekf, Popf, PopfExact, LiteralPopf, TuePredictor)),
]


@pytest.mark.parametrize("make", [*HOLDING_ARRAYS, *OTHERS])
def test_nothing_of_it_can_be_set(make):
    made = make()
    for field in fields(made):
        with pytest.raises(FrozenInstanceError):
            setattr(made, field.name, None)


@pytest.mark.parametrize("make", HOLDING_ARRAYS)
def test_what_holds_arrays_is_the_same_as_itself_alone(make):
    """Arrays have no one truth value: to compare or hash them would raise."""
    one, other = make(), make()
    assert one != other
    assert {one, other, one} == {other, one}
