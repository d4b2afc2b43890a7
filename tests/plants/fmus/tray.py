"""Somebody's robot in Python, FMI 2: flattened arrays, and no start pose to be told."""

import math

from pythonfmu import Fmi2Causality, Fmi2Slave, Real


class Tray(Fmi2Slave):
    def __init__(self, **told):
        super().__init__(**told)
        self.forward, self.turning = 0.0, 0.0
        self.pose = [1.0, 0.5, 0.0]
        for name in ("forward", "turning"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        for i in range(3):
            self.register_variable(
                Real(
                    f"pose[{i + 1}]",
                    causality=Fmi2Causality.output,
                    getter=lambda i=i: self.pose[i],
                )
            )

    def do_step(self, _time, step):
        x, y, heading = self.pose
        x += step * self.forward * math.cos(heading)
        y += step * self.forward * math.sin(heading)
        self.pose = [x, y, heading + step * self.turning]
        return True
