"""What one step of one robot costs, by each way to make it."""

import ctypes
from collections.abc import Sequence
from contextlib import ExitStack
from itertools import count, islice
from pathlib import Path

import fmpy
import numpy as np

from laglab.bench.harness import Bench, Contest, Progress, Turn, microseconds, timed
from laglab.bench.result import Figure, Result
from laglab.c_library import c_library, new_folder
from laglab_fmu import (
    INPUTS,
    OUTPUTS,
    VERSIONS,
    Fleet,
    Robot,
    RobotParameters,
    fmu_path,
)
from laglab_fmu.archive import c_files
from laglab_fmu.models import ROBOT

SPEEDS = (4.0, 9.0)
SAMPLE_TIME = RobotParameters.sample_time
OURS, METHODS, PLAIN = "our stepper", "FMPy's slave methods", "plain C loop"


def bench(robots: int, ticks: int, stack: ExitStack) -> Bench:
    """One robot stepped `ticks` times a turn by each way, and a fleet for as long.

    Args:
        robots: size of the fleet, and of the plain C loop's array.
        ticks: steps of a single robot in one turn; `simulate_fmu` makes a fifth of them.
        stack: closes what the ways have opened.

    Raises:
        FmuError: an FMU is not there, or there is no compiler for the plain C loop.
    """
    ways = {"": _ways(robots, ticks, stack)}
    contest = Contest("one step of the robot", microseconds("robot-step"), PLAIN, ways)
    return Bench("fmu", [contest], _figures)


def _figures(results: Sequence[Result], _: Progress) -> list[Figure]:
    """Ours against FMPy's."""
    (result,) = results
    figures = []
    for version in (f"FMI {version}" for version in VERSIONS):
        methods, ours = (result.fastest("", f"{version}, {way}") for way in (METHODS, OURS))
        figures.append(Figure(f"{version}: {METHODS} to {OURS}", methods / ours, "×"))
    return figures


def _ways(robots: int, ticks: int, stack: ExitStack) -> dict[str, Turn]:
    fleet_ticks = max(1, 20 * ticks // robots)
    ways = {}
    for version in VERSIONS:
        name = f"FMI {version}"
        ways[f"{name}, {OURS}"] = _stepper(version, ticks, stack)
        ways[f"{name}, {METHODS}"] = _slave_methods(version, ticks, stack)
        ways[f"{name}, simulate_fmu"] = _simulate(version, max(1, ticks // 5))
    ways[f"FMI 3, fleet of {robots}"] = _fleet(robots, fleet_ticks, stack)
    ways[PLAIN] = plain_loop(robots, fleet_ticks, stack)
    return ways


def _stepper(version: int, ticks: int, stack: ExitStack) -> Turn:
    robot = stack.enter_context(Robot.open(version, RobotParameters()))

    def run() -> None:
        for _ in range(ticks):
            robot.step(*SPEEDS)

    return timed(run, ticks)


def _slave_methods(version: int, ticks: int, stack: ExitStack) -> Turn:
    folder, path = new_folder(stack), fmu_path(version)
    fmpy.extract(path, folder)
    slave = fmpy.instantiate_fmu(folder, fmpy.read_model_description(path), "CoSimulation")
    stack.callback(slave.freeInstance)
    if version == 2:
        slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    put, get = (
        (slave.setReal, slave.getReal) if version == 2 else (slave.setFloat64, slave.getFloat64)
    )
    inputs = [ROBOT.reference[name] for name in INPUTS]
    outputs = [ROBOT.reference[name] for name in OUTPUTS]

    clock = count()

    def run() -> None:
        for tick in islice(clock, ticks):
            put(inputs, list(SPEEDS))
            slave.doStep(tick * SAMPLE_TIME, SAMPLE_TIME)
            get(outputs)

    return timed(run, ticks)


def _simulate(version: int, ticks: int) -> Turn:
    kinds = [("time", float), *((name, float) for name in INPUTS)]
    inputs = np.array([(0.0, *SPEEDS)], dtype=kinds)

    def run() -> None:
        fmpy.simulate_fmu(
            str(fmu_path(version)),
            fmi_type="CoSimulation",
            input=inputs,
            stop_time=ticks * SAMPLE_TIME,
            output_interval=SAMPLE_TIME,
        )

    return timed(run, ticks)


def _fleet(robots: int, ticks: int, stack: ExitStack) -> Turn:
    fleet = stack.enter_context(Fleet.open([RobotParameters(seed=i + 1) for i in range(robots)]))
    speeds = np.asfortranarray(np.tile(SPEEDS, (robots, 1)))

    def run() -> None:
        for _ in range(ticks):
            fleet.step(speeds)

    return timed(run, ticks * robots)


def plain_loop(robots: int, ticks: int, stack: ExitStack) -> Turn:
    sources = {
        name: text
        for name, text in c_files().items()
        if name.endswith(".h") or name.startswith(("robot", "drive", "noise"))
    }
    library = c_library(Path(__file__).with_name("plain_loop.c"), sources, stack)
    library.plain_start.restype = ctypes.c_void_p
    robot_array = ctypes.c_void_p(library.plain_start(ctypes.c_size_t(robots)))
    stack.callback(library.plain_end, robot_array)
    speeds, readings = np.tile(SPEEDS, (robots, 1)), np.zeros((robots, len(OUTPUTS)))
    # unlike bare addresses, these keep their arrays alive
    arrays = [array.ctypes.data_as(ctypes.c_void_p) for array in (speeds, readings)]

    def run() -> None:
        library.plain_loop(robot_array, ctypes.c_size_t(robots), ctypes.c_long(ticks), *arrays)

    return timed(run, ticks * robots)
