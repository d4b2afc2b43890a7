"""Estimators: pure functions over immutable states, each step under the number of its equation."""

from laglab_control.estimators.brought import METHODS
from laglab_control.estimators.calibrating.calibrating_ekf import CalibratingEkf
from laglab_control.estimators.calibrating.parameters import Parameters, Taken
from laglab_control.estimators.calibrating.wheel_scales import WheelScales
from laglab_control.estimators.delayed.backdated import Backdated
from laglab_control.estimators.delayed.delayed_ekf import DelayedEkf
from laglab_control.estimators.delayed.rewinding import Rewinding
from laglab_control.estimators.delayed.windows import ReplayedInputs, RigidMotions
from laglab_control.estimators.family import ESTIMATORS, EstimatorKind, estimator_kind
from laglab_control.estimators.interface import (
    Calibration,
    Estimator,
    InForce,
    Measured,
    State,
    claim_of,
    pose_of,
)
from laglab_control.estimators.kalman import Innovation
from laglab_control.estimators.paper.ekf import Ekf
from laglab_control.estimators.paper.popf import Popf
from laglab_control.estimators.paper.popf_exact import PopfExact
from laglab_control.estimators.paper.popf_literal import LiteralPopf
from laglab_control.estimators.tue_predictor import TuePredictor

__all__ = [
    "ESTIMATORS",
    "METHODS",
    "Backdated",
    "CalibratingEkf",
    "Calibration",
    "DelayedEkf",
    "Ekf",
    "Estimator",
    "EstimatorKind",
    "InForce",
    "Innovation",
    "LiteralPopf",
    "Measured",
    "Parameters",
    "Popf",
    "PopfExact",
    "ReplayedInputs",
    "Rewinding",
    "RigidMotions",
    "State",
    "Taken",
    "TuePredictor",
    "WheelScales",
    "claim_of",
    "estimator_kind",
    "pose_of",
]
