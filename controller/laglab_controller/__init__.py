"""The remote station: estimators, control law, and its answer to every tick of the robot."""

from laglab_controller.angle import wrap
from laglab_controller.controller import Control, Controller, StationConfig
from laglab_controller.delayed import DelayedEkf
from laglab_controller.ekf import Ekf
from laglab_controller.errata import Erratum, PrintedController
from laglab_controller.errors import ConfigError, RobotSilentError, StampError, StationError
from laglab_controller.estimator import Applied, Estimator, Measured, State
from laglab_controller.exact import PopfExact
from laglab_controller.family import ESTIMATORS
from laglab_controller.flight import Echo
from laglab_controller.law import Drive, Law
from laglab_controller.loop import run_station
from laglab_controller.model import Model, NonlinearModel
from laglab_controller.popf import Popf
from laglab_controller.replay import Replay, constant_delay, replay
from laglab_controller.rewinding import Rewinding
from laglab_controller.robot import RobotModel
from laglab_controller.session import Heard, read_session
from laglab_controller.shadow import Shadow, shadow
from laglab_controller.station import Station
from laglab_controller.watch import StationReport, TickTimes, delay_limit
from laglab_controller.windows import ReplayedInputs, RigidMotions

__all__ = [
    "ESTIMATORS",
    "Applied",
    "ConfigError",
    "Control",
    "Controller",
    "DelayedEkf",
    "Drive",
    "Echo",
    "Ekf",
    "Erratum",
    "Estimator",
    "Heard",
    "Law",
    "Measured",
    "Model",
    "NonlinearModel",
    "Popf",
    "PopfExact",
    "PrintedController",
    "Replay",
    "ReplayedInputs",
    "Rewinding",
    "RigidMotions",
    "RobotModel",
    "RobotSilentError",
    "Shadow",
    "StampError",
    "State",
    "Station",
    "StationConfig",
    "StationError",
    "StationReport",
    "TickTimes",
    "constant_delay",
    "delay_limit",
    "read_session",
    "replay",
    "run_station",
    "shadow",
    "wrap",
]
