"""The misprints of the paper that concern the filter, each a switch to see what it costs.

Why each is one: docs/theory.md, "Errata".
"""

from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import Any

import numpy as np

from laglab_control.controller import Controller
from laglab_control.estimators.interface import Estimator
from laglab_control.estimators.paper.popf import Popf
from laglab_control.flight import Flight
from laglab_control.laws import Demand, as_input
from laglab_control.model import Matrix, Vector, symmetric
from laglab_control.motion import Way, joined
from laglab_control.robot import RobotModel


class Erratum(Enum):
    """A place where the paper's filter is printed wrong: equation, as printed, as used here."""

    COVARIANCE = ("23, 28", "H_k in P+", "H_s")
    LINEARISATION = ("27", "A_k, W_k", "A_{k-1}, W_{k-1}")
    INNOVATION = ("28", "z* - h(x^-_k)", "z* - h(x^-_s)")
    EXTRAPOLATION = ("29", "u_{k+n-1}", "the command applied then")
    COMMANDED_SPEED = ("31", "v_c", "the applied v")
    WHEEL_NOISE = ("32", "+2/L, +2/L", "-2/L, +2/L")

    def __init__(self, equation: str, printed: str, used: str) -> None:
        self.equation = equation
        self.printed = printed
        self.used = used


Errata = frozenset[Erratum]


@dataclass(frozen=True, eq=False)
class PrintedRobot(RobotModel):
    """The robot with some of the errata put back. u = [v, omega, v_c] (3,) instead of (2,)."""

    errata: Errata = frozenset()

    def f(self, x: Vector, u: Vector) -> Vector:
        """(3), by the speeds applied."""
        return super().f(x, u[:2])

    def A(self, x: Vector, u: Vector) -> Matrix:
        """(31), at the speed applied, or as printed at the one commanded, v_c."""
        return super().A(x, u[2:] if Erratum.COMMANDED_SPEED in self.errata else u[:2])

    def W(self, x: Vector) -> Matrix:
        """(32), or its third row as printed: both wheels turn the robot the same way."""
        W = super().W(x)
        if Erratum.WHEEL_NOISE in self.errata:
            W[2] = np.abs(W[2])
        return W

    def predict(self, x: Vector, P: Matrix, u: Vector) -> tuple[Vector, Matrix]:
        """(27), with A and W of tick k-1; or as printed of tick k, which is at x^-_k."""
        prior = self.f(x, u)
        at = prior if Erratum.LINEARISATION in self.errata else x
        A, W = self.A(at, u), self.W(at)
        return prior, symmetric(A @ P @ A.T + W @ self.Q @ W.T)


@dataclass(frozen=True, eq=False)
class PrintedController(Controller):
    """The controller with `popf`, some of the errata put back."""

    errata: Errata = frozenset()

    @cached_property
    def _estimator(self) -> Estimator[Any]:
        model = self.config.model
        robot = PrintedRobot(
            model.sample_time, model.wheel_radius, model.track, model.Q, model.R, self.errata
        )
        return Popf(
            robot,
            innovation_at_k=Erratum.INNOVATION in self.errata,
            covariance_at_k=Erratum.COVARIANCE in self.errata,
        )

    def _applied(self, u: Vector, drive: Demand) -> Vector:
        """v_c is the speed last commanded, which comes into force n ticks later."""
        return np.append(u, drive.v)

    def _at_arrival(self, pose: Way[float], flight: Flight, drive: Demand) -> Way[float]:
        """(29), or as printed: u_{k+n-1} is not sent yet, so the last command there is, n times."""
        if Erratum.EXTRAPOLATION not in self.errata:
            return super()._at_arrival(pose, flight, drive)
        step = self.config.model.way(as_input(drive))
        for _ in range(self.config.command_delay):
            pose = joined(pose, step)
        return pose
