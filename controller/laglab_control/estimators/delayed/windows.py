"""How a belief is carried forward over a window of known inputs."""

from dataclasses import dataclass
from typing import Protocol, TypeVar

from laglab_control.estimators.kalman import Belief
from laglab_control.model import Model, Vector
from laglab_control.motion import STILL, Motion, compose, moved
from laglab_control.robot import RobotModel

W = TypeVar("W")


class Windows(Protocol[W]):
    """A window of inputs as one value, of which two in a row make one again (associatively)."""

    @property
    def identity(self) -> W:
        """The empty window."""
        ...

    def over(self, u: Vector) -> W:
        """One tick with input u."""
        ...

    def compose(self, older: W, newer: W) -> W:
        """Both, one after the other."""
        ...

    def carry(self, belief: Belief, window: W) -> Belief:
        """The belief at the end of the window, with nothing measured meanwhile."""
        ...


@dataclass(frozen=True)
class RigidMotions:
    """For the robot: each window is one Motion, however long."""

    model: RobotModel
    identity: Motion[float] = STILL

    def over(self, u: Vector) -> Motion[float]:
        """g_k."""
        return self.model.motion(u)

    def compose(self, older: Motion[float], newer: Motion[float]) -> Motion[float]:
        """One after the other."""
        return compose(older, newer)

    def carry(self, belief: Belief, window: Motion[float]) -> Belief:
        """All of (27) over the window at once."""
        return Belief(*moved(belief.x, belief.P, window))


@dataclass(frozen=True)
class ReplayedInputs:
    """For any model: the inputs themselves, replayed by (27) one by one."""

    model: Model
    identity: tuple[Vector, ...] = ()

    def over(self, u: Vector) -> tuple[Vector, ...]:
        """Just u."""
        return (u,)

    def compose(self, older: tuple[Vector, ...], newer: tuple[Vector, ...]) -> tuple[Vector, ...]:
        """One after the other."""
        return older + newer

    def carry(self, belief: Belief, window: tuple[Vector, ...]) -> Belief:
        """(27) for each."""
        for u in window:
            belief = Belief(*self.model.predict(*belief, u))
        return belief
