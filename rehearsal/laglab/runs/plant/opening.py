"""From a scenario to its plant."""

from collections.abc import Iterator
from contextlib import contextmanager

from laglab.runs.plant.brought import BroughtPlant, maker_of
from laglab.runs.plant.hand import MovedByHand
from laglab.runs.plant.opened import OpenPlant
from laglab.runs.plant.shipped import FmuPlant, robot_parameters
from laglab.runs.staying import staying
from laglab.scenario import Scenario
from laglab.scenario.tables.plant import SHIPPED
from laglab_gateway import UnplaceableError


@contextmanager
def open_plant(scenario: Scenario) -> Iterator[OpenPlant]:
    """The plant of that scenario, moved by hand where it says so.

    Raises: FmuError, PluginError: it cannot be had, or does not start;
    UnplaceableError: it is to be moved by hand, and cannot.
    """
    with _opened(scenario) as opened:
        if not scenario.plant.event:
            yield opened
            return
        if not opened.placeable:
            raise UnplaceableError(
                f"plant.event: nobody can put {scenario.plant.called} elsewhere: map its start "
                "pose (plant.start = { x = ..., y = ..., theta = ... }), or leave the events out"
            )
        plant = MovedByHand(opened.plant, scenario.plant.event, scenario.sample_time)
        yield OpenPlant(plant, opened.placeable, opened.warnings)


@contextmanager
def _opened(scenario: Scenario) -> Iterator[OpenPlant]:
    if scenario.plant.is_mapped:
        from laglab.runs.plant.foreign import open_foreign  # loads FMPy

        with open_foreign(scenario) as opened:
            yield opened
    elif scenario.plant.kind in SHIPPED:
        from laglab_fmu import Robot  # loads FMPy

        parameters = robot_parameters(scenario)
        with Robot.open(scenario.plant.fmi, parameters) as robot:
            yield OpenPlant(FmuPlant(robot, parameters))
    else:
        yield OpenPlant(BroughtPlant(scenario))


def check_plant(scenario: Scenario) -> None:
    """All that can be known to be wrong before it runs. Raises: FmuError, PluginError."""
    if scenario.plant.is_mapped:
        from laglab.runs.plant.foreign import check_foreign  # loads FMPy

        check_foreign(scenario)
    elif scenario.plant.kind not in SHIPPED:
        with staying():
            maker_of(scenario.plant.kind)
