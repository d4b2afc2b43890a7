"""Whole runs as the benches need them: all that a bench knows of scenarios and of running them."""

from pathlib import Path
from time import perf_counter
from typing import NamedTuple

from laglab import run
from laglab.errors import RunError
from laglab.runs.ending import Ending
from laglab.runs.plant.shipped import robot_parameters
from laglab.runs.rehearse import Transport, unheard
from laglab.runs.robot_side import Setup
from laglab.runs.station_side import station_config
from laglab.runs.whole import run_into
from laglab.scenario import Scenario, load
from laglab_control import INITIAL_VARIANCE, StationConfig
from laglab_fmu import RobotParameters
from laglab_gateway import TimingReport
from laglab_protocol import EndReason

SAMPLE_TIME = RobotParameters.sample_time


class Loop(NamedTuple):
    """What a loop is, for who builds it by hand. Delays in ticks."""

    command_delay: int
    measurement_delay: int
    last_tick: int
    robot: RobotParameters
    station: StationConfig


def loop_scenario(estimator: str, ticks: int) -> Scenario:
    """The delays, limits and noise of `lab`; an estimator in the loop, or none."""
    return load(
        "lab",
        {
            "estimator.kind": estimator,
            "duration": ticks * SAMPLE_TIME,
            "sample_time": SAMPLE_TIME,
            "estimator.initial_covariance": INITIAL_VARIANCE,
            "estimator.initial_estimate": "start",
        },
    )


def loop_of(scenario: Scenario) -> Loop:
    """The scenario's loop, for who builds it by hand."""
    return Loop(
        scenario.link.command_delay,
        scenario.link.measurement_delay,
        scenario.must_end(),
        robot_parameters(scenario),
        station_config(scenario),
    )


def seconds_per_tick(transport: Transport, scenario: Scenario, directory: Path) -> float:
    """Wall time [s] of one tick, as `laglab run` runs it, from its first tick to its last."""
    return _run(transport, scenario, directory).loop_seconds / scenario.must_end()


def seconds_per_run(transport: Transport, name: str) -> float:
    """Wall time [s] of a shipped scenario from Python, from the call to the result in memory."""
    began = perf_counter()
    run(name, transport=transport)
    return perf_counter() - began


def realtime_scenario(seconds: float) -> Scenario:
    """`lab`, by the clock."""
    return load("lab", {"pace": "realtime", "duration": seconds})


def lateness(seconds: float, directory: Path, live: str | None = None) -> TimingReport:
    """Of `laglab run lab --pace realtime` over UDP; `live` is how to call its live page."""
    timing = _run("udp", realtime_scenario(seconds), directory, live).timing
    assert timing is not None, "it was paced by the clock"
    return timing


def _run(
    transport: Transport, scenario: Scenario, directory: Path, live: str | None = None
) -> Ending:
    return whole(run_into(directory, scenario, transport, unheard, Setup(live=live)))


def whole(ending: Ending) -> Ending:
    """The same. Raises RunError where the loop ended early; KeyboardInterrupt: it has ended in
    order, and the bench is to end, too."""
    reason = ending.outcome and ending.outcome.reason
    if reason is EndReason.INTERRUPTED:
        raise KeyboardInterrupt
    if reason is not EndReason.COMPLETED:
        raise RunError(f"the loop ended early: {ending.problem or reason}")
    return ending
