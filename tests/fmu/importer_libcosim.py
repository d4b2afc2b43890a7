"""Runs an FMU by libcosim, prints the outputs in hexadecimal: `importer_libcosim.py FMU TICKS`."""

import sys

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

from laglab_fmu import Reading
from laglab_fmu.models import ROBOT

SAMPLE_TIME = 10_000_000  # ns


def main(fmu: str, ticks: int) -> None:
    log_output_level(CosimLogLevel.WARNING)
    execution = CosimExecution.from_step_size(SAMPLE_TIME)
    slave = CosimLocalSlave(fmu_path=fmu, instance_name="robot")
    robot = execution.add_local_slave(slave)
    execution.real_initial_value(robot, ROBOT.reference["theta_start"], 0.4)
    execution.integer_initial_value(robot, ROBOT.reference["seed"], 6)
    observer, manipulator = CosimObserver.create_last_value(), CosimManipulator.create_override()
    execution.add_observer(observer)
    execution.add_manipulator(manipulator)
    wheels = [ROBOT.reference["omega_left"], ROBOT.reference["omega_right"]]
    manipulator.slave_real_values(robot, wheels, [4.0, 9.0])
    execution.step(ticks)
    outputs = observer.last_real_values(robot, [ROBOT.reference[name] for name in Reading._fields])
    print("outputs", *(value.hex() for value in outputs), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
