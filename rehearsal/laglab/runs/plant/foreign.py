"""A plant that is an FMU with a map of names: anyone's by the scenario's, ours by our own."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from laglab.runs.plant.opened import OpenPlant
from laglab.runs.plant.placing import pose_asked, seed_of
from laglab.runs.plant.sensor import NoisySensor
from laglab.runs.plant.shipped import wheel_speeds
from laglab.scenario import Scenario
from laglab.scenario.tables.plant import POSE_NAMES
from laglab_fmu import INTEGRATIONS, WiringError, fmu_path
from laglab_fmu.foreign import FmuFile, ForeignRobot, Wiring, check
from laglab_gateway import Reading, UnplaceableError

NEAR = 1e-9
"""[m, rad] Starts no further apart are the same."""
MEASURED = tuple(f"{name}_meas" for name in POSE_NAMES)


class ForeignPlant:
    """Told body or wheel speeds; measured by its own sensor, or by ours."""

    def __init__(self, robot: ForeignRobot, told: Wiring, scenario: Scenario) -> None:
        self._robot, self._wiring, self._scenario = robot, told, scenario
        self._sensor = NoisySensor(scenario)
        self._by_wheels = "omega_left" in told.inputs
        self._placed = 0
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
        if not is_placeable(self._wiring):
            called = self._scenario.plant.called
            raise UnplaceableError(f"{called} begins where it begins: plant.start is not set")
        pose = pose_asked((x, y, theta), self._scenario.start)
        self._placed += 1
        self._robot.restart(start_values(self._wiring, self._scenario, pose, self._placed))
        self._begin()


def is_placeable(told: Wiring) -> bool:
    """Whether the whole start pose can be said."""
    return set(POSE_NAMES) <= set(told.start)


def start_values(
    told: Wiring, scenario: Scenario, pose: Sequence[float], placed: int = 0
) -> list[float]:
    """For the variables that take the start: the pose, and a seed that no placing before had."""
    there = dict(zip(POSE_NAMES, pose, strict=True))
    there["seed"] = seed_of(scenario.seed, placed)
    return [there[name] for name in told.start]


def wired(scenario: Scenario) -> tuple[Path, Wiring]:
    """Which FMU, and its map. Raises FmuNotBuiltError: one of ours is not there."""
    plant = scenario.plant
    if plant.fmu is not None:
        return plant.fmu, Wiring(**plant.names, parameters=plant.parameters)
    names = {name: name for name in (*POSE_NAMES, *MEASURED)}
    start = {name: f"{name}_start" for name in POSE_NAMES}
    own = Wiring(
        {"v": "v_command", "omega": "omega_command"},
        names,
        {**start, "seed": "seed"},
        {**_of_the_scenario(scenario), **plant.parameters},
    )
    return fmu_path(plant.fmi, plant.model), own


def _of_the_scenario(scenario: Scenario) -> dict[str, float]:
    """What the robots that ship have in common."""
    variances = zip(POSE_NAMES, scenario.plant.measurement_variance, strict=True)
    integrations = [name for name, _ in INTEGRATIONS]
    return {
        "sample_time": scenario.sample_time,
        "noise": scenario.noise,
        "integration": integrations.index(scenario.plant.integration) + 1,
        **{f"measurement_variance_{name}": variance for name, variance in variances},
    }


@contextmanager
def open_foreign(scenario: Scenario) -> Iterator[OpenPlant]:
    """Raises: FmuError."""
    path, told = wired(scenario)
    start = start_values(told, scenario, scenario.start)
    file = FmuFile.read(path)
    with _naming_the_key():
        opened = ForeignRobot(file, told, scenario.sample_time, start)
    with opened as robot:
        plant = ForeignPlant(robot, told, scenario)
        yield OpenPlant(plant, is_placeable(told), _elsewhere(scenario, plant.read()))


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
    path, told = wired(scenario)
    file = FmuFile.read(path)
    with _naming_the_key():
        check(file, told, scenario.sample_time)


@contextmanager
def _naming_the_key() -> Iterator[None]:
    """As a scenario has it."""
    try:
        yield
    except WiringError as error:
        raise WiringError(f"plant.{error}") from None
