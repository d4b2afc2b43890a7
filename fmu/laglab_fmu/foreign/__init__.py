"""Anyone's FMU as a robot: FMI 2 or 3, co-simulation, or model exchange with FMPy's solver.

`FmuFile` is what can be known without running it, `Wiring` which of its variables are whose, and
`ForeignRobot` steps it. Nothing here knows what a pose is: numbers go in and come out by name.
"""

from laglab_fmu.foreign.file import FmuFile
from laglab_fmu.foreign.robot import ForeignRobot
from laglab_fmu.foreign.start_values import check
from laglab_fmu.foreign.wiring import REAL, Value, Wiring, size

__all__ = ["REAL", "FmuFile", "ForeignRobot", "Value", "Wiring", "check", "size"]
