"""The one interface of all estimators."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple, Protocol, TypeVar

from laglab_control.errors import ControlError, StampError
from laglab_control.estimators.kalman import Innovation
from laglab_control.model import Matrix, Vector
from laglab_control.robot import Ways


class InForce(NamedTuple):
    """The input u (p,) was in force on [t_tick, t_{tick+1})."""

    tick: int
    u: Vector


class Measured(NamedTuple):
    """The measurement z_s (q,) was sampled at s = `tick`, however late it arrives."""

    tick: int
    z: Vector


class Calibration(NamedTuple):
    """What is known of one parameter of the robot."""

    name: str
    value: float
    deviation: float
    """Standard deviation."""


def by_sampling(measurements: Sequence[Measured], k: int) -> Sequence[Measured]:
    """Oldest first. Raises StampError unless all were sampled at ticks 0 ... k."""
    if len(measurements) > 1:
        measurements = sorted(measurements, key=_tick)
    if measurements and not (measurements[0].tick >= 0 and measurements[-1].tick <= k):
        stamps = ", ".join(str(s) for s, _ in measurements)
        raise StampError(f"sampled at tick {stamps}, at tick {k}: give ticks from 0 to {k}")
    return measurements


def _tick(measured: Measured) -> int:
    return measured.tick


class State(Protocol):
    """All that an estimator knows at a tick; immutable."""

    @property
    def tick(self) -> int:
        """k."""
        ...

    @property
    def x(self) -> Vector | None:
        """The estimate of x_k (d,); None while there is none, as with `raw`."""
        ...

    @property
    def P(self) -> Matrix | None:
        """Its claimed covariance (d, d); None for `raw`, which claims none."""
        ...


def pose_of(state: State) -> Vector | None:
    """The pose (3,) [m, m, rad] in the state: its `pose` if it has one, else the first three of x.

    None while there is no estimate. Raises ControlError when the state holds no pose.
    """
    x: Vector | None = getattr(state, "pose", state.x)
    if x is None or len(x) == 3:
        return x
    if len(x) < 3:
        raise ControlError(
            f"a state of {len(x)} components is no pose: let x begin with x, y, theta, or give the "
            "state a `pose`"
        )
    return x[:3]


def claim_of(state: State) -> Matrix | None:
    """The covariance (3, 3) that is claimed for the pose: the leading block of P."""
    P = state.P
    return P if P is None or len(P) == 3 else P[:3, :3]


S = TypeVar("S", bound=State)


class Estimator(Protocol[S]):
    """Pure functions over an immutable state: predict once a tick, then correct.

    At tick 0: `correct(start(x, P), ...)`. At tick k >= 1: `correct(predict(state, u), ...)` with
    u the input in force on [t_{k-1}, t_k). The delay of a measurement is read from its stamp.
    """

    def start(self, x: Vector, P: Matrix) -> S:
        """The state at tick 0, whose prior is x (d,) with covariance P (d, d)."""
        ...

    def predict(self, state: S, u: Vector) -> S:
        """One tick further, with the input u (p,) known or believed to be applied meanwhile."""
        ...

    def correct(
        self, state: S, measurements: Sequence[Measured], inputs: Sequence[InForce] = ()
    ) -> S:
        """With all that arrived at this tick: none, one or many, in any order, perhaps repeated.

        `inputs` tells of earlier ticks at which another input was in force than predict was given.
        Of two measurements sampled at the same tick, the second is a repeat and is not used.
        Raises StampError for one sampled before tick 0 or after `state.tick`.
        """
        ...

    def expect(self, state: S, s: int) -> S:
        """The same, prepared for a measurement sampled at `s`: its correction will take less time.

        Any other may come as well. By default nothing is prepared.
        """
        return state

    def ahead(self, state: S, inputs: Iterable[Vector]) -> Vector | None:
        """The pose (3,) after `inputs`, those still to be in force, a tick each; None: as (29) has
        it, with the model's f."""
        return None

    def calibrated(self, state: S, robot: Ways) -> Ways:
        """The robot as it is known by now; `robot` itself, if the estimator learns nothing."""
        return robot

    def learned(self, state: S) -> tuple[Calibration, ...]:
        """What is known by now of the robot besides its pose; of most estimators nothing."""
        return ()

    @property
    def is_watchable(self) -> bool:
        """Whether its innovations show how wild a measurement is, as a guard needs it."""
        return True

    def innovation(self, state: S) -> Innovation | None:
        """Of the newest measurement that the last `correct` was given, as the estimator saw it;
        None when it was given none, or did not use it."""
        ...

    def restart(self, state: S, x: Vector, P: Matrix) -> S:
        """Tick 0 again, with the prior x (d,), P (d, d); what else has been learned is kept."""
        return self.start(x, P)

    def warning(self, state: S) -> str | None:
        """What nobody who relies on this estimate may overlook; None while there is nothing."""
        return None
