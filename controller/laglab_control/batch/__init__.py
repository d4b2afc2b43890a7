"""Many robots at once, an array over them in place of each number.

A second, faster way to the numbers of `Controller`, for links that deliver everything on time; for
others there is `laglab_control.batch.impaired`.
"""

from laglab_control.batch.controller import BatchControl, BatchController
from laglab_control.batch.estimators import BATCHED
from laglab_control.batch.law import polar_law
from laglab_control.batch.matrices import Symmetric
from laglab_control.batch.rows import Pose, Row, Speeds

__all__ = [
    "BATCHED",
    "BatchControl",
    "BatchController",
    "Pose",
    "Row",
    "Speeds",
    "Symmetric",
    "polar_law",
]
