"""What a user wrote: filters and laws that work, and some that fail at tick 40."""

import sys
import time
from typing import NamedTuple

import numpy as np

from laglab_control import DelayedEkf, PolarLaw, RigidMotions


class State(NamedTuple):
    inner: object
    x: object
    P: object
    tick: int


class Wide:
    """delayed-ekf with more states, which are of no use."""

    def __init__(self, model, spare=2):
        self.ekf, self.spare = DelayedEkf(model, RigidMotions(model)), spare

    def _of(self, inner):
        P = np.eye(3 + self.spare)
        P[:3, :3] = inner.P
        return State(inner, np.append(inner.x, np.ones(self.spare)), P, inner.tick)

    def start(self, x, P):
        return self._of(self.ekf.start(x, P))

    def predict(self, state, u):
        return self._of(self.ekf.predict(state.inner, u))

    def correct(self, state, measurements, inputs=()):
        return self._of(self.ekf.correct(state.inner, measurements, inputs))


class Watchable(Wide):
    def innovation(self, state):
        return self.ekf.innovation(state.inner)


class Unclaiming(Wide):
    """An observer, as Luenberger's: no covariance."""

    def start(self, x, P):
        return super().start(x, P)._replace(P=None)

    def predict(self, state, u):
        return super().predict(state, u)._replace(P=None)

    def correct(self, state, measurements, inputs):
        return super().correct(state, measurements, inputs)._replace(P=None)


class Foreseeing(Wide):
    """Says itself where the robot will be."""

    def __init__(self, model):
        super().__init__(model)
        self.model = model

    def ahead(self, state, inputs):
        x = state.x[:3]
        for u in inputs:
            x = self.model.f(x, u)
        return x


class Law:
    """The paper's, by another name."""

    def __init__(self, goal, gain=3.0):
        self.law = PolarLaw(goal, gamma=gain, goal_tolerance=0.03)

    def drive(self, pose, time, memory):
        return self.law.drive(pose, time, memory)


class At40(Wide):
    """Answers something else then."""

    def correct(self, state, measurements, inputs=()):
        right = super().correct(state, measurements, inputs)
        return self.other(right) if state.tick == 40 else right


class Nan(At40):
    def other(self, right):
        return right._replace(x=right.x * np.nan)


class Complex(At40):
    def other(self, right):
        return right._replace(x=right.x + 0j)


class Objects(At40):
    def other(self, right):
        return right._replace(x=np.array([None, 1, 2, 3, 4]))


class AtHome(Wide):
    """Cannot be made in a process of ours."""

    def __init__(self, model):
        if sys.argv[0].endswith("child.py"):
            raise RuntimeError("there is no licence here")
        super().__init__(model)


class LooksItUp(At40):
    """Its state fails in a way of its own where it has no such attribute."""

    def other(self, right):
        class State:
            def __getattr__(self, name):
                return {"tick": right.tick}[name]

        return State()


class Text(At40):
    def other(self, right):
        return right._replace(x="x")


class Short(At40):
    def other(self, right):
        return right._replace(x=right.x[:2])


class NoState(At40):
    def other(self, right):
        return right.x


class NanClaim(At40):
    def other(self, right):
        return right._replace(P=right.P * np.nan)


class Failing(At40):
    def other(self, right):
        raise ValueError("something is\nwrong")


class Markup(At40):
    def other(self, right):
        raise ValueError("[/nope] see [bold] :cat:")


class Silent(Exception):
    def __str__(self):
        raise RuntimeError


class Unspeakable(At40):
    def other(self, right):
        raise Silent


class Closing(At40):
    def other(self, right):
        raise GeneratorExit


class Sleeping(At40):
    def other(self, right):
        time.sleep(3600)


class Leaving(Wide):
    def correct(self, state, measurements, inputs=()):
        raise SystemExit("I am off")


class FailingAhead(Wide):
    def predict(self, state, u):
        return {}[state.tick] if state.tick == 40 else super().predict(state, u)


class Ragged(Wide):
    def ahead(self, state, inputs):
        return [[1, 2], 3] if state.tick == 40 else None


class Guarded(Watchable):
    """Nothing has come yet, so nothing is corrected."""

    def predict(self, state, u):
        right = super().predict(state, u)
        return right._replace(x=right.x + 0j) if state.tick == 5 else right


class Asking(At40):
    def other(self, right):
        return input() and right


class Debugged(At40):
    def other(self, right):
        breakpoint()
        return right


class LawAt40(Law):
    """Answers something else from then on, 10 ticks before the command comes into force."""

    def drive(self, pose, time, memory):
        return self.other() if time > 0.495 else super().drive(pose, time, memory)


class NanLaw(LawAt40):
    def other(self):
        return float("nan"), 0.0, None


class FailingLaw(LawAt40):
    def other(self):
        return 1 / 0


class TwoNumbers(LawAt40):
    def other(self):
        return 0.0, 0.0


class TextLaw(LawAt40):
    def other(self):
        return "0.1", "0.2", None


class HugeLaw(LawAt40):
    def other(self):
        return 10**400, 0.1, None


class NoMethod:
    def __init__(self, model):
        self.start = self.predict = lambda a, b: None


class WrongSignature(Wide):
    def correct(self, state):
        return state


class NoModel:
    pass


class NoDrive:
    def __init__(self, goal):
        pass
