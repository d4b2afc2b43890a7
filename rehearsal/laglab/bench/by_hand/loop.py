"""The loop as one would write it without laglab: FMPy's slave methods and pymavlink's mavutil.

Both sides do what ours do, tick by tick and with the same estimator: the robot steps the FMU
through lists, keeps the two queues and writes a row a tick, the station answers each tick. There
is no repeat after a loss, no check of who speaks, no log of frames, no failsafe.
"""

import csv
import importlib
import os
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from queue import Queue
from time import perf_counter
from typing import Any

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave

from laglab.bench.by_hand.echo import Link
from laglab.bench.whole_run import Loop, loop_of
from laglab.errors import RunError
from laglab.runs.processes.child import Inbox, Tell, started
from laglab.runs.processes.reports import Listening, Order, Progress
from laglab.scenario import Scenario
from laglab_control import Controller, Echo, Measured
from laglab_fmu import RobotParameters, fmu_path
from laglab_gateway import TRACE_FILE, TraceRow
from laglab_protocol import STATION_COMPONENT, STATION_SYSTEM
from laglab_protocol.dialect.mavgen import offer_to_pymavlink

OUTPUTS = ("x", "y", "theta", "x_meas", "y_meas", "theta_meas")
INPUTS = ("omega_left", "omega_right")


def seconds_per_tick(over: Link, scenario: Scenario, directory: Path) -> float:
    """Wall time [s] of one tick, over the whole run; fills `directory`."""
    told = scenario.to_toml()
    inbox: Inbox = Queue()
    order = Order(told, over, str(directory))
    with started("robot", "laglab.bench.by_hand.loop:robot_process", order, inbox):
        first = inbox.get().report
        if not isinstance(first, Listening):
            raise RunError(f"the loop by hand over {over} did not start: {first}")
        order = Order(told, first.address)
        with started("station", "laglab.bench.by_hand.loop:station_process", order, inbox):
            last = inbox.get().report
            if not isinstance(last, Progress):
                raise RunError(f"the loop by hand over {over} ended early: {last}")
            return last.loop_seconds / last.tick


def robot_process(order: Order, tell: Tell) -> None:
    """Listens, drives to the last tick, and reports how long that took."""
    mavutil = _mavutil()
    loop, directory = loop_of(Scenario.from_toml(order.scenario)), Path(order.directory)
    with (
        _robot_link(mavutil, order.url) as (link, address),
        _fmu(loop.robot, directory / "fmu") as (fmu, references),
        (directory / TRACE_FILE).open("w", newline="") as file,
    ):
        trace = csv.writer(file)
        trace.writerow(TraceRow._fields)
        tell(Listening(address))
        link.recv_match(type="HEARTBEAT", blocking=True)
        began = perf_counter()
        _drive(loop, link, fmu, references, trace)
        tell(Progress(loop.last_tick, perf_counter() - began))


def _drive(loop: Loop, link: Any, fmu: FMU2Slave, references: dict[str, int], trace: Any) -> None:
    n, m, Ts = loop.command_delay, loop.measurement_delay, loop.robot.sample_time
    outputs, inputs = [references[name] for name in OUTPUTS], [references[name] for name in INPUTS]
    commands: deque[tuple[float, float]] = deque([(0.0, 0.0)] * n)
    measurements: deque[tuple[float, ...]] = deque()
    v = omega = 0.0
    for k in range(loop.last_tick + 1):
        pose = fmu.getReal(outputs)
        measurements.append((*pose[3:], v, omega, k, max(k - 1 - n, -1)))
        due = [measurements.popleft()] if k >= m else []
        for measurement in due:
            link.mav.laglab_measurement_send(*measurement)
        link.mav.laglab_tick_send(k, len(due))
        estimate, command = None, None
        while command is None:
            message = link.recv_match(type=["LAGLAB_ESTIMATE", "LAGLAB_COMMAND"], blocking=True)
            if message.get_type() == "LAGLAB_ESTIMATE":
                estimate = message
            elif message.tick == k:
                command = message
        commands.append((command.v, command.omega))
        v, omega = commands.popleft()
        seen = (estimate.x, estimate.y, estimate.theta) if estimate else ("", "", "")
        trace.writerow([k, k * Ts, *pose, *seen, command.v, command.omega, v, omega])
        half_turn, radius = omega * loop.robot.track / 2, loop.robot.wheel_radius
        fmu.setReal(inputs, [(v - half_turn) / radius, (v + half_turn) / radius])
        fmu.doStep(currentCommunicationPoint=k * Ts, communicationStepSize=Ts)


def station_process(order: Order, _: Tell) -> None:
    """Answers every tick up to the last."""
    mavutil = _mavutil()
    loop = loop_of(Scenario.from_toml(order.scenario))
    link = mavutil.mavlink_connection(
        order.url,
        baud=57600,
        source_system=STATION_SYSTEM,
        source_component=STATION_COMPONENT,
        dialect="laglab",
    )
    link.mav.heartbeat_send(6, 8, 0, 0, 4)
    controller = Controller(loop.station)
    control = controller.start()
    arrived: list[Measured] = []
    echoes: list[Echo] = []
    tick = -1
    while tick < loop.last_tick:
        message = link.recv_match(type=["LAGLAB_MEASUREMENT", "LAGLAB_TICK"], blocking=True)
        if message.get_type() == "LAGLAB_MEASUREMENT":
            z = np.array([message.x, message.y, message.theta])
            arrived.append(Measured(message.tick, z))
            u, made = np.array([message.v, message.omega]), message.command_tick
            echoes.append(Echo(message.tick - 1, u, None if made < 0 else made))
            continue
        tick = message.tick
        if tick:
            control = controller.advance(control)
        control = controller.answer(control, arrived, echoes)
        arrived, echoes = [], []
        x, P = control.estimate.x, control.estimate.P
        if x is not None and P is not None:
            link.mav.laglab_estimate_send(*x, *P[np.triu_indices(3)], tick)
        v, omega, _at_goal = control.drive
        link.mav.laglab_command_send(v, omega, tick, 1, 1, int(P is not None))
    link.close()


def _mavutil() -> Any:
    """pymavlink set to MAVLink 2, which it reads from the environment when it is imported."""
    os.environ["MAVLINK20"] = "1"
    offer_to_pymavlink()
    return importlib.import_module("pymavlink.mavutil")


@contextmanager
def _robot_link(mavutil: Any, over: str) -> Iterator[tuple[Any, str]]:
    """The robot's connection, and the address that the station opens."""
    if over == "udp":
        link = mavutil.mavlink_connection("udpin:127.0.0.1:0", dialect="laglab", source_system=1)
        host, port = link.port.getsockname()
        yield link, f"udpout:{host}:{port}"
        link.close()
        return
    import tty  # not every system has it

    mavutil.set_dialect("laglab")
    master, slave = os.openpty()
    tty.setraw(slave)
    yield _master_port(mavutil, master), os.ttyname(slave)
    os.close(master)
    os.close(slave)


def _master_port(mavutil: Any, descriptor: int) -> Any:
    """mavutil opens serial ports by name only: the near end of a pty has none."""

    class MasterPort(mavutil.mavfile):  # type: ignore[misc]
        def recv(self, n: int | None = None) -> bytes:
            return os.read(descriptor, n or self.mav.bytes_needed())

        def write(self, data: bytes) -> int:
            return os.write(descriptor, data)

    return MasterPort(descriptor, "pty", source_system=1)


@contextmanager
def _fmu(robot: RobotParameters, folder: Path) -> Iterator[tuple[FMU2Slave, dict[str, int]]]:
    """The robot as FMPy's users start it, and its value references by name."""
    description = fmpy.read_model_description(str(fmu_path(2)))
    references = {each.name: each.valueReference for each in description.modelVariables}
    fmu = FMU2Slave(
        guid=description.guid,
        modelIdentifier=description.coSimulation.modelIdentifier,
        unzipDirectory=fmpy.extract(str(fmu_path(2)), str(folder)),
    )
    fmu.instantiate()
    numbers = robot.by_name()
    for kind in ("Real", "Integer", "Boolean"):
        named = [each for each in description.modelVariables if each.name in numbers]
        names = [each.name for each in named if each.type == kind]
        references_of_kind = [references[name] for name in names]
        getattr(fmu, f"set{kind}")(references_of_kind, [numbers[name] for name in names])
    fmu.setupExperiment(startTime=0.0)
    fmu.enterInitializationMode()
    fmu.exitInitializationMode()
    yield fmu, references
    fmu.terminate()
    fmu.freeInstance()
