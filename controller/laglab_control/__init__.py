"""The mathematics, on numpy alone: model, estimators, laws, prediction over the delays.

A number in brackets, such as (28), is an equation of docs/theory.md, in this and every component.
"""

from laglab_control.angle import wrap, wrapped
from laglab_control.chi_square import chi_square_bound
from laglab_control.config import (
    FAR,
    INITIAL_VARIANCE,
    StationConfig,
    is_far,
    without_blind_guard,
)
from laglab_control.controller import Control, Controller
from laglab_control.errata import Erratum, PrintedController
from laglab_control.errors import (
    ConfigError,
    ControlError,
    PluginError,
    PluginFailedError,
    StampError,
)
from laglab_control.estimators import (
    ESTIMATORS,
    Backdated,
    CalibratingEkf,
    Calibration,
    DelayedEkf,
    Ekf,
    Estimator,
    InForce,
    LiteralPopf,
    Measured,
    Parameters,
    Popf,
    PopfExact,
    ReplayedInputs,
    Rewinding,
    RigidMotions,
    State,
    Taken,
    TuePredictor,
    WheelScales,
)
from laglab_control.estimators.kalman import normalised_squared
from laglab_control.flight import Echo, Told
from laglab_control.guard import Alarm, Guard
from laglab_control.laws import (
    LAWS,
    Circle,
    DelayMargin,
    Demand,
    Eight,
    Law,
    Path,
    PolarLaw,
    Reference,
    SpeedLimits,
    TrackingLaw,
    Waypoints,
    delay_margin,
)
from laglab_control.limits import limits
from laglab_control.model import Matrix, Model, NonlinearModel, Vector
from laglab_control.motion import Way
from laglab_control.past import MEMORY
from laglab_control.plugins import (
    Plugin,
    at_tick,
    find_plugin,
    first_line,
    installed_plugins,
    is_module_class,
)
from laglab_control.replay import Replay, constant_delay, replay
from laglab_control.robot import RobotModel

__all__ = [
    "ESTIMATORS",
    "FAR",
    "INITIAL_VARIANCE",
    "LAWS",
    "MEMORY",
    "Alarm",
    "Backdated",
    "CalibratingEkf",
    "Calibration",
    "Circle",
    "ConfigError",
    "Control",
    "ControlError",
    "Controller",
    "DelayMargin",
    "DelayedEkf",
    "Demand",
    "Echo",
    "Eight",
    "Ekf",
    "Erratum",
    "Estimator",
    "Guard",
    "InForce",
    "Law",
    "LiteralPopf",
    "Matrix",
    "Measured",
    "Model",
    "NonlinearModel",
    "Parameters",
    "Path",
    "Plugin",
    "PluginError",
    "PluginFailedError",
    "PolarLaw",
    "Popf",
    "PopfExact",
    "PrintedController",
    "Reference",
    "Replay",
    "ReplayedInputs",
    "Rewinding",
    "RigidMotions",
    "RobotModel",
    "SpeedLimits",
    "StampError",
    "State",
    "StationConfig",
    "Taken",
    "Told",
    "TrackingLaw",
    "TuePredictor",
    "Vector",
    "Way",
    "Waypoints",
    "WheelScales",
    "at_tick",
    "chi_square_bound",
    "constant_delay",
    "delay_margin",
    "find_plugin",
    "first_line",
    "installed_plugins",
    "is_far",
    "is_module_class",
    "limits",
    "normalised_squared",
    "replay",
    "without_blind_guard",
    "wrap",
    "wrapped",
]
