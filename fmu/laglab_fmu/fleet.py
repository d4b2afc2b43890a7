"""Many robots in one instance: one call moves them all."""

from collections.abc import Sequence
from functools import partial
from typing import Self

import numpy as np
import numpy.typing as npt

from laglab_fmu.models import Model, model_named
from laglab_fmu.parameters import ShippedParameters
from laglab_fmu.slave import Slave3, fleet_path
from laglab_fmu.stepper import OUTPUTS, Stepper

Array = npt.NDArray[np.float64]


class Fleet(Stepper):
    """Many robots of one model in co-simulation: `with Fleet.open([parameters, ...]) as fleet:`.

    Attributes:
        readings: (robots, 8), columns as in `Reading`; each step writes it anew.

    FMI keeps the values of one variable together, so arrays are column-major: `readings[:, 0]`, the
    x of all robots, is contiguous. `readings` is the very memory that the FMU writes.
    """

    @classmethod
    def open(cls, robots: Sequence[ShippedParameters]) -> Self:
        """Robots at their start poses, tick 0 sampled; robot i moves as one alone of robots[i].

        Raises:
            ValueError: no robots, or their models or sample times differ; no such integration,
                seed or name.
            FmuNotBuiltError: the FMU is not there.
            CallError: it does not start, or refuses a parameter.
        """
        return cls(robots)

    def __init__(self, robots: Sequence[ShippedParameters]) -> None:
        model = self._model = common_model(robots)
        make = partial(Slave3, model=model, fleet=True)
        super().__init__(fleet_path(model.name), make, robots, model.inputs)
        self._speeds: Array = np.zeros((len(model.inputs), len(robots))).T
        self.readings: Array = np.zeros((len(OUTPUTS), len(robots))).T
        self.outputs.value = self.readings.ctypes.data
        self.fetch()

    def step(self, speeds: Array) -> Array:
        """Moves all robots for one sample time and gives `readings`.

        Args:
            speeds: (robots, 2), of a `Robot` its left and right wheel's in rad/s, of others v in
                m/s and omega in rad/s. The FMU reads a column-major array of float64 (numpy's
                order="F") where it lies; any other is copied first.

        Raises:
            ValueError: speeds of another shape.
            CallError: the FMU refused, for instance a speed that is not finite; nothing moved.
        """
        if np.shape(speeds) != self._speeds.shape:
            raise ValueError(f"speeds are {np.shape(speeds)}, not {self._speeds.shape}")
        if not (speeds.dtype == np.float64 and speeds.flags.f_contiguous):
            self._speeds[:] = speeds
            speeds = self._speeds
        self.inputs.value = speeds.ctypes.data
        self.advance()
        return self.readings

    def reset(self, robots: Sequence[ShippedParameters]) -> None:
        """Starts again with as many robots, without loading anything anew.

        Raises:
            ValueError: another number or model of robots, or sample times that differ.
            CallError: the FMU refuses a parameter; reset again with better ones.
        """
        if len(robots) != len(self.readings):
            raise ValueError(f"{len(robots)} robots for a fleet of {len(self.readings)}")
        if (model := common_model(robots)) is not self._model:
            raise ValueError(f"{model.name} for a fleet of {self._model.name}")
        self.restart(robots)
        self.fetch()


def common_model(robots: Sequence[ShippedParameters]) -> Model:
    """What all the robots are. Raises ValueError: there is no robot, or they differ."""
    models = {robot.model for robot in robots}
    if len(models) != 1:
        raise ValueError(f"{len(robots)} robots are of {len(models)} models, not of one")
    return model_named(models.pop())
