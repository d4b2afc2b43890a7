"""Filters, laws and plants that are right but for one thing each."""

import itertools
import math
import os
import random
import time

import numpy as np
from mine import Law, Wide


class Right(Wide):
    """As good as delayed-ekf."""

    optimal = True

    def __init__(self, model):
        super().__init__(model, spare=0)


class Impure(Right):
    """Its answer depends on how often it was asked."""

    calls = itertools.count()

    def predict(self, state, u):
        right = super().predict(state, u)
        return right._replace(x=right.x + 1e-13 * (next(self.calls) % 2))


class Mutating(Right):
    def correct(self, state, measurements, inputs=()):
        right = super().correct(state, measurements, inputs)
        state.x[0] += 1e-15
        return right


class Sharing(Right):
    """Every version of its state has the same list behind it."""

    def start(self, x, P):
        return self._with(self.ekf.start(x, P), [])

    def _with(self, inner, log):
        return self._of(inner)._replace(inner=(inner, log))

    def predict(self, state, u):
        inner, log = state.inner
        log.append(u)
        return self._with(self.ekf.predict(inner, u), log)

    def correct(self, state, measurements, inputs=()):
        inner, log = state.inner
        right = self._with(self.ekf.correct(inner, measurements, inputs), log)
        return right._replace(x=right.x + 1e-12 * len(log))


class Unordered(Right):
    """Weighs what came first the most."""

    def correct(self, state, measurements, inputs=()):
        right = super().correct(state, measurements, inputs)
        stamps = [s for s, _ in measurements]
        return right._replace(x=right.x + 1e-4) if stamps != sorted(stamps) else right


class Repeating(Right):
    """A measurement that comes twice moves its estimate once more."""

    def correct(self, state, measurements, inputs=()):
        right = super().correct(state, measurements, inputs)
        stamps = [s for s, _ in measurements]
        return right._replace(x=right.x + 1e-4) if len(set(stamps)) < len(stamps) else right


class Late(Right):
    """Loses its way when a measurement is later than fifty ticks."""

    def correct(self, state, measurements, inputs=()):
        right = super().correct(state, measurements, inputs)
        late = any(state.tick - s > 50 for s, _ in measurements)
        return right._replace(x=right.x + 0.02) if late else right


class AnyStamp(Right):
    def correct(self, state, measurements, inputs=()):
        measurements = [each for each in measurements if 0 <= each.tick <= state.tick]
        return super().correct(state, measurements, inputs)


class NoOptimum(Right):
    """Does without every second measurement, and claims a larger P, as it must."""

    def correct(self, state, measurements, inputs=()):
        some = [each for each in measurements if each.tick % 2 or not 0 <= each.tick <= state.tick]
        return super().correct(state, some, inputs)


class Overconfident(Right):
    optimal = False

    def _of(self, inner):
        right = super()._of(inner)
        return right._replace(P=right.P / 4)


class Admitting(Overconfident):
    admits = {"NEES": "we say so"}


class Slow(Right):
    seconds = 0.0

    def correct(self, state, measurements, inputs=()):
        until = time.perf_counter() + self.seconds
        while time.perf_counter() < until:
            pass
        return super().correct(state, measurements, inputs)


class NoLaw(Law):
    def drive(self, pose):
        return 0.0, 0.0, None


class Infinite(Law):
    """Divides by the distance."""

    def drive(self, pose, time, memory):
        x, y, _ = pose
        rho = math.hypot(x - self.law.goal[0], y - self.law.goal[1])
        return min(1.0, 1 / rho), 0.0, None


class Huge(Law):
    """Answers an int that is too large for a float."""

    def drive(self, pose, time, memory):
        return 10**400 if time > 1e3 else 0.1, 0.0, None


class Dicing(Law):
    def drive(self, pose, time, memory):
        v, omega, memory = super().drive(pose, time, memory)
        return v + random.random() * (abs(pose[2]) > 3), omega, memory


class Appending(Law):
    """Remembers in a list that it never hands over."""

    def drive(self, pose, time, memory):
        v, omega, _ = super().drive(pose, time, None)
        memory = [] if memory is None else memory
        memory.append(v)
        return sum(memory), omega, memory


class Sleeping(Law):
    def drive(self, pose, time_, memory):
        time.sleep(3600)


class Leaving(Law):
    def drive(self, pose, time, memory):
        os._exit(7)


class RightPlant:
    """A unicycle."""

    def __init__(self, sample_time, start, seed):
        self.Ts, self.start, self.random = sample_time, start, np.random.default_rng(seed)
        self.pose, self.speeds = list(start), (0.0, 0.0)
        self.sense()

    def sense(self):
        self.seen = [a + 0.1 * self.random.standard_normal() for a in self.pose]

    def read(self):
        return (*self.pose, *self.seen, *self.speeds)

    def step(self, v, omega):
        x, y, theta = self.pose
        self.pose = [
            x + self.Ts * v * math.cos(theta),
            y + self.Ts * v * math.sin(theta),
            theta + self.Ts * omega,
        ]
        self.speeds = v, omega
        self.sense()

    def place(self, x, y, theta):
        self.pose = [
            b if math.isnan(a) else a for a, b in zip((x, y, theta), self.start, strict=True)
        ]
        self.speeds = 0.0, 0.0
        self.sense()


class Plain(RightPlant):
    """Nobody tells it of NaN."""

    def place(self, x, y, theta):
        self.pose, self.speeds = [x, y, theta], (0.0, 0.0)
        self.sense()


class Halting(RightPlant):
    """At tick 20."""

    ticks = 0

    def step(self, v, omega):
        super().step(v, omega)
        self.ticks += 1
        if self.ticks == 20:
            raise RuntimeError("the motor burnt")


class ShortReading(RightPlant):
    def read(self):
        return self.pose


class Unseeded(RightPlant):
    def __init__(self, sample_time, start, seed):
        super().__init__(sample_time, start, None)


class Stirring(RightPlant):
    def read(self):
        seen = super().read()
        self.sense()
        return seen


class Immovable(RightPlant):
    def place(self, x, y, theta):
        pass


class Degrees(RightPlant):
    def step(self, v, omega):
        super().step(v, math.degrees(omega))
        self.speeds = v, omega


def made_by_a_function(model):
    return Right(model)
