"""Many of the robots that ship: what each is told before it starts."""

from laglab.runs.plant.foreign import start_values, wired
from laglab.runs.plant.shipped import robot_parameters
from laglab.scenario import Scenario
from laglab_fmu import OtherParameters, ShippedParameters


def fleet_parameters(scenario: Scenario) -> ShippedParameters:
    """Of the robot that moves as the scenario's does when it is alone."""
    plant = scenario.plant
    if not plant.is_mapped:
        return robot_parameters(scenario)
    _, told = wired(scenario)
    start = zip(told.start.values(), start_values(told, scenario, scenario.start), strict=True)
    return OtherParameters(plant.model, {**told.parameters, **dict(start)})
