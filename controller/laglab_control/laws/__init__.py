"""Control laws: a pose in, speeds out."""

from laglab_control.laws.interface import STAND_STILL, Demand, Law, as_input
from laglab_control.laws.margin import DelayMargin, delay_margin
from laglab_control.laws.polar import PolarLaw
from laglab_control.laws.speed_limits import SpeedLimits

__all__ = [
    "STAND_STILL",
    "DelayMargin",
    "Demand",
    "Law",
    "PolarLaw",
    "SpeedLimits",
    "as_input",
    "delay_margin",
]
