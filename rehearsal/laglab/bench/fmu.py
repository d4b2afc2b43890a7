"""What one step of one robot costs, by each way to make it, measured side by side."""

import ctypes
import tempfile
import time
from collections.abc import Callable
from contextlib import ExitStack
from itertools import count, islice
from pathlib import Path
from typing import NamedTuple

import fmpy
import numpy as np

from laglab_fmu import c_compiler
from laglab_fmu.compiler import compile_library, host_platform
from laglab_fmu.contents import c_files
from laglab_fmu.fleet import Fleet
from laglab_fmu.parameters import RobotParameters
from laglab_fmu.robot import Robot
from laglab_fmu.slave import VERSIONS, fmu_path
from laglab_fmu.stepper import INPUTS, OUTPUTS
from laglab_fmu.variables import REFERENCE

SPEEDS = (4.0, 9.0)
SAMPLE_TIME = 0.01
PLAIN = "plain C loop"

Measure = Callable[[], tuple[float, int]]
"""Runs once; gives seconds and robot-steps."""


class Row(NamedTuple):
    """One way to step."""

    name: str
    seconds: float
    """per robot-step, the best of the repeats"""
    ratio: float
    """to the plain C loop over as many robots as the fleet has"""


def bench(robots: int = 1000, ticks: int = 3000, repeats: int = 5) -> list[Row]:
    """Steps one robot `ticks` times by each way, and a fleet for as long, in turns.

    Args:
        robots: size of the fleet, and of the plain C loop's array.
        ticks: steps of a single robot in one turn; `simulate_fmu` makes a fifth of them.
        repeats: turns; the best of each way counts.

    Raises:
        FmuError: an FMU is not there, or there is no compiler for the plain C loop.
    """
    with ExitStack() as stack:
        ways = _ways(robots, ticks, stack)
        best = dict.fromkeys(ways, float("inf"))
        for _ in range(repeats):
            for name, measure in ways.items():
                seconds, steps = measure()
                best[name] = min(best[name], seconds / steps)
    return [Row(name, seconds, seconds / best[PLAIN]) for name, seconds in best.items()]


def _ways(robots: int, ticks: int, stack: ExitStack) -> dict[str, Measure]:
    fleet_ticks = max(1, 20 * ticks // robots)
    ways = {}
    for version in VERSIONS:
        name = f"FMI {version}"
        ways[f"{name}, our stepper"] = _stepper(version, ticks, stack)
        ways[f"{name}, FMPy's slave methods"] = _slave_methods(version, ticks, stack)
        ways[f"{name}, simulate_fmu"] = _simulate(version, max(1, ticks // 5))
    ways[f"FMI 3, fleet of {robots}"] = _fleet(robots, fleet_ticks, stack)
    ways[PLAIN] = _plain(robots, fleet_ticks, stack)
    return ways


def _timed(run: Callable[[], None], steps: int) -> tuple[float, int]:
    begin = time.perf_counter()
    run()
    return time.perf_counter() - begin, steps


def _stepper(version: int, ticks: int, stack: ExitStack) -> Measure:
    robot = stack.enter_context(Robot.open(version, RobotParameters()))

    def run() -> None:
        for _ in range(ticks):
            robot.step(*SPEEDS)

    return lambda: _timed(run, ticks)


def _slave_methods(version: int, ticks: int, stack: ExitStack) -> Measure:
    folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="laglab-bench-"))
    path = fmu_path(version)
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
    inputs = [REFERENCE[name] for name in INPUTS]
    outputs = [REFERENCE[name] for name in OUTPUTS]

    clock = count()

    def run() -> None:
        for tick in islice(clock, ticks):
            put(inputs, list(SPEEDS))
            slave.doStep(tick * SAMPLE_TIME, SAMPLE_TIME)
            get(outputs)

    return lambda: _timed(run, ticks)


def _simulate(version: int, ticks: int) -> Measure:
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

    return lambda: _timed(run, ticks)


def _fleet(robots: int, ticks: int, stack: ExitStack) -> Measure:
    fleet = stack.enter_context(Fleet.open([RobotParameters(seed=i + 1) for i in range(robots)]))
    speeds = np.asfortranarray(np.tile(SPEEDS, (robots, 1)))

    def run() -> None:
        for _ in range(ticks):
            fleet.step(speeds)

    return lambda: _timed(run, ticks * robots)


def _plain(robots: int, ticks: int, stack: ExitStack) -> Measure:
    library = ctypes.CDLL(str(_compile_plain_loop(stack)))
    library.plain_start.restype = ctypes.c_void_p
    robot_array = ctypes.c_void_p(library.plain_start(ctypes.c_size_t(robots)))
    stack.callback(library.plain_end, robot_array)
    speeds, readings = np.tile(SPEEDS, (robots, 1)), np.zeros((robots, len(OUTPUTS)))
    # unlike bare addresses, these keep their arrays alive
    arrays = [array.ctypes.data_as(ctypes.c_void_p) for array in (speeds, readings)]

    def run() -> None:
        library.plain_loop(robot_array, ctypes.c_size_t(robots), ctypes.c_long(ticks), *arrays)

    return lambda: _timed(run, ticks * robots)


def _compile_plain_loop(stack: ExitStack) -> Path:
    folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="laglab-bench-")))
    needed = {
        name: text
        for name, text in c_files().items()
        if name.endswith(".h") or name.startswith(("robot", "noise"))
    }
    needed["plain_loop.c"] = Path(__file__).with_name("plain_loop.c").read_bytes()
    for name, text in needed.items():
        (folder / name).write_bytes(text)
    library = f"plain_loop{host_platform().suffix}"
    sources = sorted(name for name in needed if name.endswith(".c"))
    compile_library(folder, sources, library, c_compiler())
    return folder / library
