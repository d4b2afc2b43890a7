"""What a station says of all its controllers together."""

import numpy as np

from laglab_control import Control, Controller, Measured, StationConfig
from laglab_station.alarms import Alarms


def gating() -> tuple[Controller, Control]:
    """One to which a wild measurement came, which it did not use."""
    controller = Controller(StationConfig("delayed-ekf", guard=True))
    wild = Measured(0, np.array((500.0, 0.0, 0.0)))
    control = controller.answer(controller.start(), [wild])
    assert controller.gated(control) == 1
    return controller, control


def test_what_was_too_wild_is_counted_over_all_controllers() -> None:
    alarms = Alarms()
    for _ in range(2):
        alarms.handed_over(*gating())
    assert alarms.gated(*gating()) == 3
