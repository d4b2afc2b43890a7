"""Anyone's FMU as the gateway's plant, by the scenario's map of names."""

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from laglab.runs.plant.opened import OpenPlant
from laglab.runs.plant.sensor import NoisySensor
from laglab.runs.plant.shipped import wheel_speeds
from laglab.scenario import Scenario
from laglab.scenario.tables.plant import POSE_NAMES
from laglab_fmu.foreign import FmuFile, ForeignRobot, Wiring, check
from laglab_gateway import Reading, UnplaceableError

NEAR = 1e-9
"""[m, rad] A start that is so near is the same."""


class ForeignPlant:
    """Told body or wheel speeds; measured by its own sensor, or by ours."""

    def __init__(self, robot: ForeignRobot, scenario: Scenario) -> None:
        self._robot, self._scenario = robot, scenario
        self._sensor = NoisySensor(scenario)
        self._by_wheels = "omega_left" in scenario.plant.wired_inputs
        self._begin()

    def _begin(self) -> None:
        self._speeds = (0.0, 0.0)
        self._reading = self._sampled(self._robot.outputs)

    def _sampled(self, outputs: Sequence[float]) -> Reading:
        pose, measured = outputs[:3], outputs[3:] or self._sensor.sample(outputs)
        return Reading._make((*pose, *measured, *self._speeds))

    def read(self) -> Reading:
        """The FMU's outputs at this tick, and the speeds that it was told last."""
        return self._reading

    def step(self, v: float, omega: float) -> None:
        """One tick of the FMU."""
        plant = self._scenario.plant
        told = (v, omega)
        if self._by_wheels:
            told = wheel_speeds(v, omega, plant.wheel_radius, plant.track / 2)
        self._speeds = v, omega
        self._sensor.draw()
        self._reading = self._sampled(self._robot.step(told))

    def place(self, x: float, y: float, theta: float) -> None:
        """Start the FMU again from there. Raises UnplaceableError: its start is not mapped."""
        plant = self._scenario.plant
        if not is_placeable(self._scenario):
            raise UnplaceableError(f"{plant.called} begins where it begins: plant.start is not set")
        asked = zip((x, y, theta), self._scenario.start, strict=True)
        pose = [there if math.isnan(each) else each for each, there in asked]
        self._robot.restart([pose[POSE_NAMES.index(name)] for name in plant.wired_start])
        self._begin()


def is_placeable(scenario: Scenario) -> bool:
    """Whether the whole start pose can be said."""
    return set(scenario.plant.wired_start) == set(POSE_NAMES)


def wiring(scenario: Scenario) -> Wiring:
    """By the scenario's map."""
    plant = scenario.plant
    return Wiring(plant.wired_inputs, plant.wired_outputs, plant.wired_start, plant.parameters)


@contextmanager
def open_foreign(scenario: Scenario) -> Iterator[OpenPlant]:
    """Raises: FmuError."""
    assert scenario.plant.fmu is not None
    file, told = FmuFile.read(scenario.plant.fmu), wiring(scenario)
    start = [scenario.start[POSE_NAMES.index(name)] for name in told.start]
    with ForeignRobot(file, told, scenario.sample_time, start) as robot:
        plant = ForeignPlant(robot, scenario)
        yield OpenPlant(plant, is_placeable(scenario), _elsewhere(scenario, plant.read()))


def _elsewhere(scenario: Scenario, reading: Reading) -> tuple[str, ...]:
    """A warning, where the robot does not start as the scenario has it."""
    there = reading[:3]
    if all(abs(a - b) <= NEAR for a, b in zip(there, scenario.start, strict=True)):
        return ()
    told = ", ".join(f"{each:g}" for each in there)
    return (
        f"{scenario.plant.called} starts at ({told}), not at the scenario's start: set start to "
        "that, or map plant.start",
    )


def check_foreign(scenario: Scenario) -> None:
    """All that can be known to be wrong before the FMU runs. Raises: FmuError."""
    assert scenario.plant.fmu is not None
    check(FmuFile.read(scenario.plant.fmu), wiring(scenario), scenario.sample_time)
