"""Estimators whose state is not the pose alone."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pytest

import laglab
from laglab_control import ESTIMATORS, Estimator
from laglab_control.estimators.family import EstimatorKind


class Padded(NamedTuple):
    """A pose with something else behind it, or before it."""

    inner: Any
    before: int
    behind: int

    @property
    def tick(self) -> int:
        return int(self.inner.tick)

    @property
    def x(self) -> Any:
        return np.concatenate((np.ones(self.before), self.inner.x, np.ones(self.behind)))

    @property
    def P(self) -> Any:
        size = len(self.x)
        P = np.eye(size)
        P[:3, :3] = self.inner.P
        return P


class Elsewhere(Padded):
    """It says itself where the pose is."""

    @property
    def pose(self) -> Any:
        return self.inner.x


@dataclass(frozen=True)
class Wide(Estimator[Padded]):
    """`delayed-ekf` with other components."""

    inner: Any
    kind: type[Padded]
    before: int = 0
    behind: int = 0

    def start(self, x: Any, P: Any) -> Padded:
        return self._with(self.inner.start(x, P))

    def predict(self, state: Padded, u: Any) -> Padded:
        return self._with(self.inner.predict(state.inner, u))

    def correct(self, state: Padded, measurements: Any, inputs: Any = ()) -> Padded:
        return self._with(self.inner.correct(state.inner, measurements, inputs))

    def innovation(self, state: Padded) -> Any:
        return self.inner.innovation(state.inner)

    def _with(self, inner: Any) -> Padded:
        return self.kind(inner, self.before, self.behind)


def registered(monkeypatch: pytest.MonkeyPatch, **shape: Any) -> None:
    plain = ESTIMATORS["delayed-ekf"]
    wide = EstimatorKind("a test", lambda model: Wide(plain.make(model), **shape))
    monkeypatch.setitem(ESTIMATORS, "wide", wide)  # type: ignore[arg-type]


@pytest.mark.parametrize("guard", [False, True])
@pytest.mark.parametrize(
    "shape", [{"kind": Padded, "behind": 2}, {"kind": Elsewhere, "before": 1, "behind": 1}]
)
def test_the_pose_is_where_it_begins_or_where_the_state_says(
    monkeypatch: pytest.MonkeyPatch, shape: dict[str, Any], guard: bool
) -> None:
    registered(monkeypatch, **shape)
    overrides = {"estimator.guard": guard, "duration": 3.0}
    wide = laglab.run("lab", {**overrides, "estimator.kind": "wide"}).trace
    plain = laglab.run("lab", {**overrides, "estimator.kind": "delayed-ekf"}).trace
    for column in ("x", "x_est", "theta_est", "v_sent"):
        assert np.array_equal(wide[column], plain[column])


def test_a_state_without_a_pose_is_refused_in_one_line(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Any, refused: Callable[..., str]
) -> None:
    class Narrow(Padded):
        @property
        def x(self) -> Any:
            return self.inner.x[:2]

    registered(monkeypatch, kind=Narrow)
    options = ("--estimator", "wide", "--transport", "inline", "--out", tmp_path / "r")
    assert "a state of 2 components is no pose" in refused("run", "lab", *options)
