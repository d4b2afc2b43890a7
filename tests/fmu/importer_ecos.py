"""Runs an FMU by Ecos, prints the outputs in hexadecimal: `importer_ecos.py FMU TICKS`."""

import sys

from ecospy import EcosSimulation, EcosSimulationStructure

from laglab_fmu import Reading

START = {"theta_start": 0.4, "seed": 6, "omega_left": 4.0, "omega_right": 9.0}


def main(fmu: str, ticks: int) -> None:
    with EcosSimulationStructure() as structure:
        structure.add_model("robot", fmu)
        structure.add_parameter_set("start", {f"robot::{k}": value for k, value in START.items()})
        with EcosSimulation(structure=structure, step_size=0.01) as simulation:
            simulation.init(parameter_set="start")
            simulation.step(ticks)
            outputs = [simulation.get_real(f"robot::{name}") for name in Reading._fields]
            simulation.terminate()
    print("outputs", *(value.hex() for value in outputs), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
