"""The mathematics, on numpy alone: model, estimators, laws, prediction over the delays.

A number in brackets, such as (28), is an equation of docs/theory.md, in this and every component.
"""

from laglab_control.angle import wrap
from laglab_control.chi_square import chi_square_bound
from laglab_control.controller import (
    FAR,
    INITIAL_VARIANCE,
    Control,
    Controller,
    StationConfig,
    is_far,
)
from laglab_control.errata import Erratum, PrintedController
from laglab_control.errors import ConfigError, ControlError, StampError
from laglab_control.estimators import (
    ESTIMATORS,
    Applied,
    CalibratingEkf,
    Calibration,
    DelayedEkf,
    Ekf,
    Estimator,
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
from laglab_control.flight import Echo
from laglab_control.guard import Alarm, Guard
from laglab_control.laws import DelayMargin, Demand, Law, PolarLaw, SpeedLimits, delay_margin
from laglab_control.model import Model, NonlinearModel
from laglab_control.plugins import (
    Plugin,
    PluginError,
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
    "Alarm",
    "Applied",
    "CalibratingEkf",
    "Calibration",
    "ConfigError",
    "Control",
    "ControlError",
    "Controller",
    "DelayMargin",
    "DelayedEkf",
    "Demand",
    "Echo",
    "Ekf",
    "Erratum",
    "Estimator",
    "Guard",
    "Law",
    "LiteralPopf",
    "Measured",
    "Model",
    "NonlinearModel",
    "Parameters",
    "Plugin",
    "PluginError",
    "PolarLaw",
    "Popf",
    "PopfExact",
    "PrintedController",
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
    "TuePredictor",
    "WheelScales",
    "chi_square_bound",
    "constant_delay",
    "delay_margin",
    "find_plugin",
    "first_line",
    "installed_plugins",
    "is_far",
    "is_module_class",
    "normalised_squared",
    "replay",
    "wrap",
]
