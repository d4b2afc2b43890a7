"""A robot that somebody brings as a class, watched: whatever it does wrong is said in one line."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, Self

from laglab.runs.plant.placing import pose_asked
from laglab.scenario import Scenario
from laglab.scenario.tables.plant import SHIPPED
from laglab_control import PluginFailedError, at_tick, find_plugin
from laglab_control.plugins import Maker, called, made, refuse_misfit, shown
from laglab_gateway import Reading

METHODS = {"read": (), "step": ("v", "omega"), "place": ("x", "y", "theta")}


def maker_of(kind: str) -> Maker:
    """The class of that name. Raises PluginError."""
    return find_plugin("laglab.plants", kind, tuple(SHIPPED))


class PluginPlant:
    """Somebody's object. Every method raises PluginFailedError, when it fails or answers what is no
    reading."""

    def __init__(self, name: str, one: Any) -> None:
        self._name, self._one = name, one

    @classmethod
    def made(
        cls,
        kind: str,
        sample_time: float,
        start: Sequence[float],
        seed: int,
        options: Mapping[str, object],
    ) -> Self:
        """An object of that class. Raises PluginError: it cannot be made, or is no plant."""
        one = made(kind, maker_of(kind), sample_time, start, seed, **options)
        for method, parameters in METHODS.items():
            refuse_misfit(kind, one, method, *parameters)
        return cls(kind, one)

    def read(self) -> Reading:
        """Its answer as a reading."""
        answer = called(self._name, self._one, "read")
        try:
            reading = Reading(*(float(each * 1.0) for each in answer))  # or it takes a text
        except Exception:  # whatever is in it, as an int that is too large for a float
            wanted = ", ".join(Reading._fields)
            raise self._wrong(f"must answer {wanted}, not {shown(answer)}") from None
        for name, number in reading._asdict().items():
            if not math.isfinite(number):
                raise self._wrong(f"{name} must be finite, not {number}")
        return reading

    def _wrong(self, what: str) -> PluginFailedError:
        return PluginFailedError(f"{self._name}.read: {what}")

    def step(self, v: float, omega: float) -> None:
        """One tick."""
        called(self._name, self._one, "step", v, omega)

    def place(self, x: float, y: float, theta: float) -> None:
        """Elsewhere."""
        called(self._name, self._one, "place", x, y, theta)


class BroughtPlant:
    """Somebody's object as the gateway's plant, read once a tick. An error names the tick."""

    def __init__(self, scenario: Scenario) -> None:
        """Raises PluginError: it cannot be made, or is no plant."""
        plant, self._start, self._tick = scenario.plant, scenario.start, 0
        self._one = PluginPlant.made(
            plant.kind, scenario.sample_time, scenario.start, scenario.seed, plant.options
        )
        self._reading = self._read()

    def _read(self) -> Reading:
        with at_tick(self._tick):
            return self._one.read()

    def read(self) -> Reading:
        """What it said at this tick."""
        return self._reading

    def step(self, v: float, omega: float) -> None:
        """One tick of it."""
        with at_tick(self._tick):
            self._one.step(v, omega)
        self._tick += 1
        self._reading = self._read()

    def place(self, x: float, y: float, theta: float) -> None:
        """Put it there; NaN stands for the start pose's."""
        with at_tick(self._tick):
            self._one.place(*pose_asked((x, y, theta), self._start))
        self._reading = self._read()
