"""Where the robot was, as far as the trace knows: a real robot only knows what it measures."""

import numpy as np
from numpy.typing import NDArray

from laglab_gateway import Trace

AXES = ("x", "y", "theta")


def is_measured(trace: Trace) -> bool:
    """Whether the true pose is unknown."""
    return bool(np.isnan(trace["x"]).all())


def robot_pose(trace: Trace) -> NDArray[np.float64]:
    """The true pose at every tick, or else the measured one, shape (ticks + 1, 3) [m, m, rad]."""
    suffix = "_meas" if is_measured(trace) else ""
    return np.stack([trace[axis + suffix] for axis in AXES], axis=1)
