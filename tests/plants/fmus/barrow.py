"""Somebody's robot in Python, FMI 3: commands and pose as arrays, and a parameter."""

import math

import numpy as np
from pythonfmu3 import (
    Dimension,
    Float64,
    Fmi3Causality,
    Fmi3Slave,
    Fmi3Status,
    Fmi3StepResult,
    Fmi3Variability,
)


class Barrow(Fmi3Slave):
    def __init__(self, **told):
        super().__init__(**told)
        self.time = 0.0
        self.twist = np.zeros(2)
        self.pose = np.zeros((1, 3))
        self.wear = 1.0
        continuous = Fmi3Variability.continuous
        self.register_variable(
            Float64("time", causality=Fmi3Causality.independent, variability=continuous)
        )
        self.register_variable(
            Float64(
                "twist",
                causality=Fmi3Causality.input,
                start=[0.0, 0.0],
                dimensions=[Dimension(start="2")],
                setter=self._told,
            )
        )
        self.register_variable(
            Float64(
                "pose",
                causality=Fmi3Causality.output,
                dimensions=[Dimension(start="1"), Dimension(start="3")],
            )
        )
        self.register_variable(
            Float64(
                "wear",
                causality=Fmi3Causality.parameter,
                variability=Fmi3Variability.tunable,
                start=1.0,
            )
        )

    def _told(self, values):
        self.twist[:] = values

    def do_step(self, _time, step):
        speed, turn = self.twist * self.wear
        heading = self.pose[0, 2]
        self.pose += step * np.array([speed * math.cos(heading), speed * math.sin(heading), turn])
        return Fmi3StepResult(status=Fmi3Status.ok)
