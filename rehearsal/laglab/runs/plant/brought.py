"""A robot that somebody brings as a class, watched: whatever it does wrong is said in one line."""

import math
from collections.abc import Callable
from typing import TypeVar

from laglab.scenario import Scenario
from laglab.scenario.tables.plant import SHIPPED
from laglab_control.plugins import Maker, find_plugin
from laglab_gateway import Plant, PlantError, Reading

METHODS = ("read", "step", "place")
Given = TypeVar("Given")


def maker_of(kind: str) -> Maker:
    """The class of that name. Raises PluginError."""
    return find_plugin("laglab.plants", kind, tuple(SHIPPED))


class BroughtPlant:
    """Somebody's object, as the gateway's plant."""

    def __init__(self, name: str, plant: Plant, start: tuple[float, float, float]) -> None:
        self._name, self._plant, self._start = name, plant, start
        self._tick = 0
        self._reading = self._read()

    @classmethod
    def made(cls, scenario: Scenario) -> "BroughtPlant":
        """Of the scenario's kind. Raises: PluginError, PlantError."""
        kind, options = scenario.plant.kind, scenario.plant.options
        maker = maker_of(kind)
        try:
            plant = maker(scenario.sample_time, scenario.start, scenario.seed, **options)
        except Exception as error:  # whatever a stranger's class does when it is made
            raise PlantError(f"{kind}: {_told(error)}") from error
        if missing := [each for each in METHODS if not callable(getattr(plant, each, None))]:
            raise PlantError(f"{kind}: a plant must have {', '.join(missing)}, which this has not")
        return cls(kind, plant, scenario.start)  # type: ignore[arg-type]

    def _watched(self, call: str, work: Callable[[], Given]) -> Given:
        try:
            return work()
        except Exception as error:  # whatever a stranger's class does
            raise self._wrong(call, _told(error)) from error

    def _wrong(self, call: str, what: str) -> PlantError:
        return PlantError(f"{self._name}: tick {self._tick}: {call}: {what}")

    def _read(self) -> Reading:
        given: object = self._watched("read", self._plant.read)
        if not isinstance(given, tuple) or len(given) != len(Reading._fields):
            names = ", ".join(Reading._fields)
            raise self._wrong("read", f"must give a Reading ({names}), not {_short(given)}")
        for name, number in zip(Reading._fields, given, strict=True):
            if isinstance(number, bool) or not _is_finite(number):
                raise self._wrong("read", f"{name} must be a finite number, not {_short(number)}")
        return Reading(*map(float, given))

    def read(self) -> Reading:
        """What it said at this tick."""
        return self._reading

    def step(self, v: float, omega: float) -> None:
        """One tick of it. Raises PlantError."""
        self._watched("step", lambda: self._plant.step(v, omega))
        self._tick += 1
        self._reading = self._read()

    def place(self, x: float, y: float, theta: float) -> None:
        """Put it there. Raises PlantError."""
        asked = zip((x, y, theta), self._start, strict=True)
        pose = [there if math.isnan(each) else each for each, there in asked]
        self._watched("place", lambda: self._plant.place(*pose))
        self._reading = self._read()


def _is_finite(number: object) -> bool:
    try:
        return math.isfinite(number)  # type: ignore[arg-type]
    except TypeError:
        return False


def _told(error: Exception) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())


def _short(value: object, longest: int = 60) -> str:
    text = repr(value)
    return text if len(text) <= longest else f"{text[:longest]}..."
