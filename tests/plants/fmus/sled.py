"""Somebody's robot in Python, FMI 3: arrays sized by a structural parameter, and of three types."""

import math

import numpy as np
from pythonfmu3 import (
    Boolean,
    Dimension,
    Float64,
    Fmi3Causality,
    Fmi3Slave,
    Fmi3Status,
    Fmi3StepResult,
    Fmi3Variability,
    Int32,
    UInt64,
)


class Sled(Fmi3Slave):
    def __init__(self, **told):
        super().__init__(**told)
        self.time, self.size = 0.0, 3
        self.twist, self.pose, self.start = np.zeros((3, 3))
        self.gear, self.on = np.ones(2, int), np.ones(3, bool)
        continuous = Fmi3Variability.continuous
        self.register_variable(
            Float64("time", causality=Fmi3Causality.independent, variability=continuous)
        )
        size = UInt64(
            "size",
            causality=Fmi3Causality.structuralParameter,
            variability=Fmi3Variability.fixed,
            start=3,
        )
        self.register_variable(size)
        by_size = [Dimension(valueReference="1")]
        inputs, outputs = Fmi3Causality.input, Fmi3Causality.output
        self.register_variable(
            Float64(
                "twist", causality=inputs, start=[0.0] * 3, dimensions=by_size, setter=self._told
            )
        )
        self.register_variable(Float64("pose", causality=outputs, dimensions=by_size))
        of = {"causality": Fmi3Causality.parameter, "variability": Fmi3Variability.tunable}
        self.register_variable(
            Float64("start", start=[0.0] * 3, dimensions=by_size, setter=self._placed, **of)
        )
        two = [Dimension(start="2")]
        self.register_variable(
            Int32("gear", start=[1, 1], dimensions=two, setter=self._geared, **of)
        )
        self.register_variable(
            Boolean("on", start=[True] * 3, dimensions=by_size, setter=self._switched, **of)
        )

    def _told(self, values):
        self.twist[:] = values

    def _placed(self, values):
        self.pose[:] = values

    def _geared(self, values):
        self.gear[:] = values

    def _switched(self, values):
        self.on[:] = values

    def do_step(self, _time, step):
        speed, turn, drift = self.twist * self.on
        heading = self.pose[2]
        ahead = self.gear[0] * speed + drift
        self.pose += step * np.array([ahead * math.cos(heading), ahead * math.sin(heading), turn])
        return Fmi3StepResult(status=Fmi3Status.ok)
