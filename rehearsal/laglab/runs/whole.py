"""A whole run, both sides, its record in a folder."""

from contextlib import closing
from pathlib import Path

from laglab.runs.ending import Ending
from laglab.runs.glance import OnTick
from laglab.runs.rehearse import Transport, rehearse_apart, rehearse_inline
from laglab.runs.robot_side import Setup
from laglab.scenario import Scenario
from laglab_control import Controller
from laglab_gateway import FileRecorder, TraceError
from laglab_station import MakeController


def run_into(
    directory: Path,
    scenario: Scenario,
    transport: Transport,
    told: OnTick,
    setup: Setup | None = None,
    controller: MakeController = Controller,
) -> Ending:
    """Both sides to the end; `told` of the ticks. What breaks is in the ending. `controller`: in
    this process."""
    ending = _ending(directory, scenario, transport, told, setup, controller)
    if ending.outcome:
        told(ending.outcome.tick, None)
    return ending


def _ending(
    directory: Path,
    scenario: Scenario,
    transport: Transport,
    told: OnTick,
    setup: Setup | None,
    controller: MakeController,
) -> Ending:
    if transport != "inline":
        return rehearse_apart(scenario, transport, directory, told, setup)
    try:
        with closing(FileRecorder(directory)) as recorder:
            return rehearse_inline(scenario, recorder, told, setup, controller)
    except TraceError as error:
        return Ending(problem=str(error))
