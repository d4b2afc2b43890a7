"""An estimator that somebody brought: whatever goes wrong in it is said in a line that names it."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from laglab_control.errors import PluginFailedError
from laglab_control.estimators.interface import (
    Calibration,
    Estimator,
    InForce,
    Measured,
    State,
    pose_of,
)
from laglab_control.estimators.kalman import Innovation
from laglab_control.model import Matrix, Vector
from laglab_control.motion import Way
from laglab_control.plugins import (
    Maker,
    called,
    in_one_line,
    made,
    one_line,
    refuse_misfit,
    shown,
)
from laglab_control.robot import RobotModel, Ways

METHODS = {
    "start": ("x", "P"),
    "predict": ("state", "u"),
    "correct": ("state", "measurements", "inputs"),
}
"""The methods that every estimator has, and what each is given."""
OPTIONAL = {
    "ahead": ("state", "inputs"),
    "calibrated": ("state", "robot"),
    "expect": ("state", "s"),
    "innovation": ("state",),
    "learned": ("state",),
    "restart": ("state", "x", "P"),
    "warning": ("state",),
}


def brought_estimator(
    name: str, maker: Maker, model: RobotModel, options: dict[str, object]
) -> "Brought":
    """`Class(model, **options)`. Raises PluginError, naming what it lacks."""
    estimator = made(name, maker, model, **options)
    for method, parameters in METHODS.items():
        refuse_misfit(name, estimator, method, *parameters)
    for method, parameters in OPTIONAL.items():
        if hasattr(estimator, method):
            refuse_misfit(name, estimator, method, *parameters)
    return Brought(name, estimator)


@dataclass(frozen=True, eq=False)
class Brought(Estimator[State]):
    """Around an object with the METHODS and any of those that are OPTIONAL.

    Every method raises PluginFailedError when the object's own fails, or answers what is no state:
    one with the right `tick`, a finite `x` (d,) with a pose in it, and a finite `P` (d, d) or None.
    """

    name: str
    estimator: Any

    def start(self, x: Vector, P: Matrix) -> State:
        """The state at tick 0."""
        return self._whole("start", self._said("start", x, P), 0)

    def predict(self, state: State, u: Vector) -> State:
        """One tick further. Looked at here too: where nothing came a guard does not correct."""
        return self._whole("predict", self._said("predict", state, u), state.tick + 1)

    def correct(
        self, state: State, measurements: Sequence[Measured], inputs: Sequence[InForce] = ()
    ) -> State:
        """With what arrived."""
        corrected = self._said("correct", state, measurements, inputs)
        return self._whole("correct", corrected, state.tick)

    def restart(self, state: State, x: Vector, P: Matrix) -> State:
        """Tick 0 again."""
        if not self._has("restart"):
            return self.start(x, P)
        return self._whole("restart", self._said("restart", state, x, P), 0)

    def expect(self, state: State, s: int) -> State:
        """The same, prepared."""
        if not self._has("expect"):
            return state
        return self._whole("expect", self._said("expect", state, s), state.tick)

    def calibrated(self, state: State, robot: Ways) -> Ways:
        """The robot as it is known by now."""
        if not self._has("calibrated"):
            return robot
        ways: object = self._said("calibrated", state, robot)
        if ways is robot:
            return robot
        if not hasattr(ways, "way"):
            raise self._failed("calibrated", f"a robot with a method way(u), not {shown(ways)}")
        return BroughtRobot(f"{self.name}.calibrated", ways)

    def learned(self, state: State) -> tuple[Calibration, ...]:
        """What is known of the robot besides its pose."""
        if not self._has("learned"):
            return ()
        answer = self._said("learned", state)
        try:
            return tuple(_calibration(*each) for each in answer)
        except Exception:  # whatever is in it
            wanted = "a name, a finite value and its deviation for each parameter"
            raise self._failed("learned", f"{wanted}, not {shown(answer)}") from None

    def innovation(self, state: State) -> Innovation | None:
        """Of the newest measurement."""
        if not self._has("innovation"):
            return None
        answer = self._said("innovation", state)
        if answer is None:
            return None
        try:
            value, S = answer
        except Exception:  # it is no pair, or has an __iter__ of its own
            value = S = None
        if not (_is_whole(value, 3) and _is_whole(S, 3, 3)):
            raise self._failed(
                "innovation",
                f"None, or a finite array z - h(x) (3,) and its S (3, 3), not {shown(answer)}",
            )
        return Innovation(value, S)

    def warning(self, state: State) -> str | None:
        """What must not be overlooked."""
        said = self._said("warning", state) if self._has("warning") else None
        if said is None:
            return None
        if not isinstance(said, str):
            raise self._failed("warning", f"a text or None, not {shown(said)}")
        return in_one_line(said)

    @property
    def is_watchable(self) -> bool:
        """Whether a guard can see how wild a measurement is."""
        return self._has("innovation")

    def ahead(self, state: State, inputs: Iterable[Vector]) -> Vector | None:
        """Where it says that the robot will be (3,)."""
        if not self._has("ahead"):
            return None
        answer = self._said("ahead", state, list(inputs))
        if answer is None:
            return None
        try:
            pose = np.asarray(answer)
        except Exception:  # of rows of several lengths, or what has an __array__ of its own
            pose = np.empty(0)
        if pose.shape != (3,) or not _is_finite(pose):
            raise self._failed("ahead", f"a finite pose (3,), not {shown(answer)}")
        return pose

    def _has(self, method: str) -> bool:
        return hasattr(self.estimator, method)

    def _said(self, method: str, *told: object) -> Any:
        return called(self.name, self.estimator, method, *told)

    def _failed(self, method: str, wanted: str) -> PluginFailedError:
        return PluginFailedError(f"{self.name}.{method} must answer {wanted}")

    def _refuse_other(self, method: str, state: State, tick: int) -> None:
        try:
            there = state.tick
        except Exception:  # it may look its attributes up by itself
            raise self._failed(method, f"a state with tick, x and P, not {shown(state)}") from None
        if there != tick:
            raise self._failed(method, f"a state of tick {tick}, not {shown(there)}")

    def _whole(self, method: str, state: State, tick: int) -> State:
        self._refuse_other(method, state, tick)
        try:
            x, P, pose = state.x, state.P, pose_of(state)
        except Exception as error:  # as above, or it has no place in the plane
            raise self._failed(method, f"a state with tick, x and P: {one_line(error)}") from error
        if x is None:
            return state
        if not isinstance(x, np.ndarray) or x.ndim != 1 or not _is_finite(x):
            raise self._failed(method, f"a finite array x (d,), not {shown(x)}")
        if not _is_whole(pose, 3):
            raise self._failed(method, f"a finite pose (3,), not {shown(pose)}")
        if P is not None and not _is_whole(P, len(x), len(x)):
            raise self._failed(method, f"a finite P {(len(x), len(x))} or None, not {shown(P)}")
        return state


@dataclass(frozen=True, eq=False)
class BroughtRobot(Ways):
    """Around what a brought estimator takes the robot for."""

    name: str
    robot: Any

    def way(self, u: Vector) -> Way[float]:
        """Raises PluginFailedError when it fails, or is nowhere in the plane."""
        answer = called(self.name, self.robot, "way", u)
        try:
            x, y, theta = map(_finite, answer)
        except Exception:  # whatever is in it
            raise PluginFailedError(
                f"{self.name}.way must answer a finite x, y and theta, not {shown(answer)}"
            ) from None
        return Way(x, y, theta)


def _calibration(name: object, value: object, deviation: object) -> Calibration:
    if not (isinstance(name, str) and name.isprintable()):
        raise TypeError("name")
    return Calibration(name, _finite(value), _finite(deviation))


def _finite(number: Any) -> float:
    """Raises whatever its own operators do, and ValueError."""
    taken = float(number * 1.0)  # float() takes a text, too
    if not math.isfinite(taken):
        raise ValueError("not finite")
    return taken


def _is_whole(values: object, *shape: int) -> bool:
    return isinstance(values, np.ndarray) and values.shape == shape and _is_finite(values)


def _is_finite(values: Vector) -> bool:
    return values.dtype.kind == "f" and bool(np.isfinite(values).all())
