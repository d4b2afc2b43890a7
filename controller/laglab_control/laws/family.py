"""The laws by name, and those that users bring."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from laglab_control.errors import ConfigError, PluginFailedError
from laglab_control.laws.interface import Demand, Law
from laglab_control.laws.paths import Path
from laglab_control.laws.tracking import TrackingLaw
from laglab_control.motion import Way
from laglab_control.plugins import (
    called,
    find_plugin,
    made,
    refuse_misfit,
    shown,
)

LAWS: Mapping[str, str] = {
    "polar": "drives to the goal in polar coordinates, as the paper's",
    "tracking": "follows the path that is given with it (Kanayama et al. 1990)",
}
"""What there is by name, and what it does."""

Options = Mapping[str, Any]
"""The keyword arguments of a class: nobody but the class knows their types."""


def tracking_law(path: Path, options: Options) -> TrackingLaw:
    """The tracking law along `path`. Raises ConfigError for an option that is none or cannot be."""
    gains = [field.name for field in fields(TrackingLaw) if field.name != "path"]
    if unknown := [name for name in options if name not in gains]:
        raise ConfigError(f"law.options: tracking has {', '.join(gains)}, not {unknown[0]}")
    return TrackingLaw(path, **options)


def brought_law(name: str, goal: tuple[float, float, float], options: Options) -> Law:
    """`module:Class` or a plug-in, made as `Class(goal, **options)`. Raises PluginError."""
    law = made(name, find_plugin("laglab.laws", name, tuple(LAWS)), goal, **options)
    refuse_misfit(name, law, "drive", "pose", "time", "memory")
    return BroughtLaw(name, law)


@dataclass(frozen=True)
class BroughtLaw(Law):
    """A law that somebody brought: whatever goes wrong in it is said in a line that names it."""

    name: str
    law: Any

    def drive(self, pose: Way[float], time: float, memory: object) -> Demand:
        """Raises PluginFailedError when it fails, or does not answer finite speeds and a memory."""
        answer = called(self.name, self.law, "drive", pose, time, memory)
        try:
            v, omega, memory = answer
            demand = Demand(float(v * 1.0), float(omega * 1.0), memory)  # float() takes a text, too
        except Exception:  # whatever is in it, as an int that is too large for a float
            raise PluginFailedError(
                f"{self.name}.drive: must answer v, omega and a memory, not {shown(answer)}"
            ) from None
        if not (math.isfinite(demand.v) and math.isfinite(demand.omega)):
            raise PluginFailedError(
                f"{self.name}.drive: must answer finite speeds, not v = {demand.v:g}, "
                f"omega = {demand.omega:g}"
            )
        return demand
