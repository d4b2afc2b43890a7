"""What the station knew at every tick of a run, and what other filters make of what it heard."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab_control import (
    Control,
    Controller,
    Echo,
    InForce,
    Measured,
    StationConfig,
    normalised_squared,
)

Array = NDArray[np.float64]
NOTHING = np.full((3, 3), np.nan)


class Known(NamedTuple):
    """One filter at one tick; NaN where it says nothing."""

    x: Array
    """(3,)."""
    P: Array
    """(3, 3)."""
    nis: float
    """Of the newest measurement that came."""
    ahead: Array
    """x̂_{k+n} (3,)."""
    ahead_P: Array
    """(3, 3)."""
    n: int
    came: bool
    """Whether measurements came."""


def known(controller: Controller, control: Control, news: bool) -> Known:
    """All that a filter knows at this tick; `news`: whether a measurement came."""
    x, P, n = control.pose, control.P, control.flight.command_delay
    if x is None or not np.all(np.isfinite(x)):
        return Known(NOTHING[0], NOTHING, np.nan, NOTHING[0], NOTHING, n, news)
    innovation = controller.innovation(control) if news else None
    nis = normalised_squared(innovation) if innovation else np.nan
    there, there_P = controller.at_arrival(control) or (NOTHING[0], NOTHING)
    return Known(x, NOTHING if P is None else P, nis, there, there_P, n, news)


@dataclass(frozen=True, eq=False)
class Overhearing(Controller):
    """The station's controller, with others beside it that hear the same and whose commands are
    its own; what they all say is kept in `said`, by filter, tick by tick."""

    others: Sequence[str] = ()
    """Filters, as they are: without a guard."""
    said: dict[str, list[Known]] = field(default_factory=dict)
    _beside: dict[str, Control] = field(default_factory=dict)

    @cached_property
    def _controllers(self) -> dict[str, Controller]:
        configs = {name: self._config_of(name) for name in self.others}
        return {name: Controller(config) for name, config in configs.items()}

    def _config_of(self, name: str) -> StationConfig:
        return replace(self.config, estimator=name, estimator_options={}, guard=False)

    def start(self) -> Control:
        """Of all of them."""
        self.said.clear()
        self._beside.update({name: each.start() for name, each in self._controllers.items()})
        return super().start()

    def answer(
        self,
        control: Control,
        measurements: Sequence[Measured],
        echoes: Sequence[Echo] = (),
        recalled: Sequence[InForce] = (),
    ) -> Control:
        """The station's own; the others follow it up to here."""
        news = bool(measurements)
        for name, beside in list(self._beside.items()):
            each = self._controllers[name]
            while beside.flight.tick < control.flight.tick:
                beside = each.advance(beside)
            beside = self._beside[name] = each.answer(beside, measurements, echoes, recalled)
            self._note(name, known(each, beside, news))
        control = super().answer(control, measurements, echoes, recalled)
        self._beside.update({n: b._replace(drive=control.drive) for n, b in self._beside.items()})
        self._note(self.config.estimator, known(self, control, news))
        return control

    def _note(self, name: str, what: Known) -> None:
        """NaN for what has become infinite, which says no more."""
        self.said.setdefault(name, []).append(what)
        if not np.isfinite(what.x).all():
            self._beside.pop(name, None)
