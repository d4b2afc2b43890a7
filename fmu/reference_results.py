"""Writes content/Robot_out.csv: what the FMU answers to Robot_in.csv in its default experiment.

Run it after a change that is meant to change the numbers; a test compares them otherwise.
"""

from pathlib import Path

import numpy as np
from fmpy import simulate_fmu
from fmpy.util import read_csv, write_csv

from laglab_fmu import RobotParameters, fmu_path
from laglab_fmu.archive.description import STOP_TIME

CONTENT = Path(__file__).parent / "content"


def results(fmu: Path) -> np.ndarray:
    """The default experiment in co-simulation, as a structured array with `time` first."""
    inputs = read_csv(CONTENT / "Robot_in.csv")
    return simulate_fmu(
        str(fmu),
        fmi_type="CoSimulation",
        input=inputs,
        stop_time=STOP_TIME,
        output_interval=RobotParameters.sample_time,
    )


if __name__ == "__main__":
    write_csv(CONTENT / "Robot_out.csv", results(fmu_path(3)))
