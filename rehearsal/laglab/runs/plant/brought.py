"""A robot that somebody brings as a class, watched: whatever it does wrong is said in one line."""

import math
from collections.abc import Sequence
from typing import Any

from laglab.scenario import Scenario
from laglab.scenario.tables.plant import SHIPPED
from laglab_control.plugins import (
    Maker,
    PluginFailedError,
    at_tick,
    called,
    find_plugin,
    made,
    refuse_misfit,
    shown,
)
from laglab_gateway import Reading

METHODS = {"read": (), "step": ("v", "omega"), "place": ("x", "y", "theta")}


def maker_of(kind: str) -> Maker:
    """The class of that name. Raises PluginError."""
    return find_plugin("laglab.plants", kind, tuple(SHIPPED))


class BroughtPlant:
    """Somebody's object, as the gateway's plant. Every method raises PluginFailedError."""

    def __init__(self, name: str, one: Any, start: Sequence[float]) -> None:
        self._name, self._one, self._start = name, one, start
        self._tick = 0
        self._reading = self._read()

    @classmethod
    def made(cls, scenario: Scenario) -> "BroughtPlant":
        """Of the scenario's kind. Raises PluginError: it cannot be made, or is no plant."""
        kind, told = scenario.plant.kind, (scenario.sample_time, scenario.start, scenario.seed)
        one = made(kind, maker_of(kind), *told, **scenario.plant.options)
        for method, parameters in METHODS.items():
            refuse_misfit(kind, one, method, *parameters)
        return cls(kind, one, scenario.start)

    def _read(self) -> Reading:
        with at_tick(self._tick):
            answer = called(self._name, self._one, "read")
            try:
                reading = Reading(*map(float, answer))
            except (TypeError, ValueError):
                wanted = ", ".join(Reading._fields)
                raise self._wrong(f"must answer {wanted}, not {shown(answer)}") from None
            for name, number in reading._asdict().items():
                if not math.isfinite(number):
                    raise self._wrong(f"{name} must be finite, not {number}")
            return reading

    def _wrong(self, what: str) -> PluginFailedError:
        return PluginFailedError(f"{self._name}.read: {what}")

    def read(self) -> Reading:
        """What it said at this tick."""
        return self._reading

    def step(self, v: float, omega: float) -> None:
        """One tick of it."""
        with at_tick(self._tick):
            called(self._name, self._one, "step", v, omega)
        self._tick += 1
        self._reading = self._read()

    def place(self, x: float, y: float, theta: float) -> None:
        """Put it there; NaN stands for the start pose's."""
        asked = zip((x, y, theta), self._start, strict=True)
        pose = [there if math.isnan(each) else each for each, there in asked]
        with at_tick(self._tick):
            called(self._name, self._one, "place", *pose)
        self._reading = self._read()
