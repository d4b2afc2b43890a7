"""Filters whose optional methods answer something else than they must."""

import numpy as np
from mine import Watchable


class Innovating(Watchable):
    """Its innovation is not the robot's pose, from tick 40 on."""

    def innovation(self, state):
        right = super().innovation(state)
        return self.other(right) if right and state.tick >= 40 else right


class Two(Innovating):
    def other(self, right):
        return np.zeros(2), np.eye(2)


class One(Innovating):
    def other(self, right):
        return np.zeros(1), np.eye(1)


class Four(Innovating):
    def other(self, right):
        return np.zeros(4), np.eye(4)


class Lists(Innovating):
    def other(self, right):
        return right.value.tolist(), right.S.tolist()


class Column(Innovating):
    def other(self, right):
        return right.value.reshape(3, 1), right.S


class Variances(Innovating):
    """A 1-D S."""

    def other(self, right):
        return right.value, np.diag(right.S)


class Keyed(Innovating):
    def other(self, right):
        return {"value": right.value, "S": right.S}


class Nan(Innovating):
    def other(self, right):
        return right.value * np.nan, right.S


class Single(Innovating):
    def other(self, right):
        return 3.0


class Torn(Innovating):
    """A generator that fails under way."""

    def other(self, right):
        yield right.value
        raise RuntimeError


class Once(Watchable):
    """At tick 40 alone: only who looks at every tick sees it."""

    def innovation(self, state):
        return 1.0 if state.tick == 40 else super().innovation(state)
