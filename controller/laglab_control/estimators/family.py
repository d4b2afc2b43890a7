"""The estimators by name, for the robot."""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from laglab_control.errors import ConfigError
from laglab_control.estimators.brought import brought_estimator
from laglab_control.estimators.calibrating.calibrating_ekf import CalibratingEkf
from laglab_control.estimators.calibrating.wheel_scales import WheelScales
from laglab_control.estimators.delayed.delayed_ekf import DelayedEkf
from laglab_control.estimators.delayed.rewinding import Rewinding
from laglab_control.estimators.delayed.windows import RigidMotions
from laglab_control.estimators.interface import Estimator
from laglab_control.estimators.paper.ekf import Ekf
from laglab_control.estimators.paper.popf import Popf
from laglab_control.estimators.paper.popf_exact import PopfExact
from laglab_control.estimators.paper.raw import Raw
from laglab_control.estimators.tue_predictor import TuePredictor
from laglab_control.past.memory import MEMORY
from laglab_control.plugins import Maker, find_plugin, first_line
from laglab_control.robot import RobotModel


class EstimatorKind(NamedTuple):
    """What an estimator is, and how to make it for a robot."""

    description: str
    make: Callable[[RobotModel], Estimator[Any]]
    predicts: bool = True
    """Whether it gives an estimate of the present, which can be extrapolated and reported."""
    learner: Callable[[RobotModel], Estimator[Any]] | None = None
    """What takes over when a guard finds that its model is wrong."""
    most_late: int | None = None
    """How many ticks late a measurement may come, to be used; None: as late as it likes, or nobody
    knows."""
    admits: Mapping[str, str] = MappingProxyType({})
    """Which checks of `laglab check` it does not pass, and why."""


LATE_FOR_FRESH = {
    "delays": "it compares a late measurement with where the robot is",
    "NEES": "so it is surer than it may be",
}

ESTIMATORS: Mapping[str, EstimatorKind] = {
    "raw": EstimatorKind(
        "no filter and no prediction: the newest measurement",
        lambda _: Raw(),
        predicts=False,
        admits={"delays": "it takes what was measured late for the present"},
    ),
    "ekf": EstimatorKind(
        "the plain EKF, which takes a late measurement for a fresh one",
        lambda model: Rewinding(Ekf(model)),
        admits=LATE_FOR_FRESH,
    ),
    "popf": EstimatorKind(
        "the paper's filter",
        lambda model: Rewinding(Popf(model)),
        most_late=Popf.memory - 1,
    ),
    "popf-printed": EstimatorKind(
        "the paper's filter with the innovation as (28) prints it",
        lambda model: Rewinding(Popf(model, innovation_at_k=True)),
        most_late=Popf.memory - 1,
        admits=LATE_FOR_FRESH,
    ),
    "popf-exact": EstimatorKind(
        "the structure of popf with the true cross-covariances",
        lambda model: Rewinding(PopfExact(model)),
        most_late=PopfExact.memory - 1,
    ),
    "tue-predictor": EstimatorKind(
        "a copy of the robot, pulled to where the robot was seen to have been",
        lambda model: Rewinding(TuePredictor(model)),
        most_late=MEMORY - 1,
    ),
    "delayed-ekf": EstimatorKind(
        "the optimum: an EKF at the measurement's tick, carried forward over the known inputs",
        lambda model: DelayedEkf(model, RigidMotions(model)),
        # Something is known to be wrong by then: it may be larger, and change faster, than usual.
        learner=lambda model: CalibratingEkf(model, WheelScales(model.track, 0.1, 0.1)),
        most_late=2 * DelayedEkf.memory,  # back to where it is at most, and from there as far
    ),
    "calibrating-ekf": EstimatorKind(
        "delayed-ekf that learns how far each wheel leads: for worn robots, less exact on others",
        lambda model: CalibratingEkf(model, WheelScales(model.track)),
        most_late=2 * CalibratingEkf.memory,
    ),
}


def estimator_kind(name: str, options: Mapping[str, object] | None = None) -> EstimatorKind:
    """The estimator of that name: shipped, of a plug-in, or `module:Class`.

    Raises PluginError, listing the names, when there is none, and ConfigError for options of one
    that has none.
    """
    told = dict(options or {})
    if name not in ESTIMATORS:
        return _brought(name, find_plugin("laglab.estimators", name, tuple(ESTIMATORS)), told)
    if told:
        raise ConfigError(f"estimator.options: {name} has none, so leave {', '.join(told)} out")
    return ESTIMATORS[name]


def _brought(name: str, maker: Maker, options: dict[str, object]) -> EstimatorKind:
    return EstimatorKind(
        first_line(maker),
        lambda model: brought_estimator(name, maker, model, options),
        predicts=bool(getattr(maker, "predicts", True)),
    )
