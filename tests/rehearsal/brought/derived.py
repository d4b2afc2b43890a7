"""Filters built on Backdated that fail at tick 30, in their file or beneath it."""

from dataclasses import dataclass

import mine
import numpy as np
import tomlkit

from laglab_control import Backdated


class Derived(Backdated):
    """An EKF, up to its 21st correction: at tick 30."""

    count = 0

    def forward(self, x, P, u):
        return self.model.predict(x, P, u)

    def corrected(self, x, P, z):
        self.count += 1
        K = P @ np.linalg.inv(P + self.model.R)
        right = x + K @ self.model.innovation(z, x), P - K @ P
        return self.other(*right) if self.count == 21 else right


class Raising(Derived):
    def other(self, x, P):
        raise ValueError("here")  # the line that is told


class InNumpy(Derived):
    def other(self, x, P):
        np.linalg.inv(0 * P)  # the line that is told


class InOurs(Derived):
    def other(self, x, P):
        self.model.f(None, x)  # the line that is told


class InLibrary(Derived):
    def other(self, x, P):
        tomlkit.parse("=")  # the line that is told


class InAnother(Derived):
    def other(self, x, P):
        mine.Failing(self.model).other(None)


@dataclass(frozen=True)
class Frozen:
    x: object


class InNoFile(Derived):
    def other(self, x, P):
        Frozen(x).x = P  # the line that is told


class ListOfX(Derived):
    def other(self, x, P):
        return x.tolist(), P


class Column(Derived):
    def other(self, x, P):
        return x.reshape(3, 1), P


class Variances(Derived):
    def other(self, x, P):
        return x, np.diag(P)


class Nothing(Derived):
    def other(self, x, P):
        return None


class ListForward(Derived):
    def forward(self, x, P, u):
        x, P = super().forward(x, P, u)
        return x.tolist(), P
