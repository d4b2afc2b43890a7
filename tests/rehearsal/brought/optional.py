"""Filters whose optional methods answer something else than they must."""

import math

import numpy as np
from mine import Watchable, Wide


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


class NoParameters(Wide):
    def learned(self, state):
        return None


class Numbers(Wide):
    def learned(self, state):
        return [1, 2]


class NanParameter(Wide):
    def learned(self, state):
        return [("track", math.nan, 0.1)]


class HugeParameter(Wide):
    def learned(self, state):
        return [("track", 10**400, 0.1)]


class Nameless(Wide):
    def learned(self, state):
        return [(None, 1.0, 0.1)]


class Learning(Wide):
    """As it must."""

    def learned(self, state):
        return [("track", np.float64(1.01), 0)]

    def calibrated(self, state, robot):
        return Turning(robot)

    def warning(self, state):
        return "two\nlines \udc80"


class Turning:
    """A robot that answers what `other` makes of where it gets."""

    def __init__(self, robot, other=tuple):
        self.robot, self.other = robot, other

    def way(self, u):
        return self.other(self.robot.way(u))


class NoRobot(Wide):
    def calibrated(self, state, robot):
        return None


class Calibrating(Wide):
    def calibrated(self, state, robot):
        return Turning(robot, self.other) if state.tick >= 40 else robot


class NoWay(Calibrating):
    def other(self, right):
        return None


class NanWay(Calibrating):
    def other(self, right):
        return right._replace(x=math.nan)


class TextWay(Calibrating):
    def other(self, right):
        return "xyt"


class FailingWay(Calibrating):
    def other(self, right):
        raise ValueError("lost")


class Warnings(Wide):
    def warning(self, state):
        return ["two", "texts"]


class NoExpectation(Wide):
    def expect(self, state, s):
        return None


class NoRestart(Wide):
    def restart(self, state, x, P):
        return None
