"""The plant that a scenario names, whoever made it: ours, somebody's FMU, somebody's class.

`open_plant` makes it; all else in the package knows only what it does (`laglab_gateway.Plant`).
"""

from laglab.runs.plant.opened import OpenPlant
from laglab.runs.plant.opening import check_plant, open_plant
from laglab.runs.plant.shipped import FmuPlant

__all__ = ["FmuPlant", "OpenPlant", "check_plant", "open_plant"]
