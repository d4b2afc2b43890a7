"""Control laws: a pose in, speeds out."""

from laglab_control.laws.family import LAWS, brought_law, tracking_law
from laglab_control.laws.interface import STAND_STILL, Demand, Law, as_input
from laglab_control.laws.margin import DelayMargin, delay_margin
from laglab_control.laws.paths import Circle, Eight, Path, Reference, Waypoints
from laglab_control.laws.polar import PolarLaw
from laglab_control.laws.speed_limits import SpeedLimits
from laglab_control.laws.tracking import TrackingLaw

__all__ = [
    "LAWS",
    "STAND_STILL",
    "Circle",
    "DelayMargin",
    "Demand",
    "Eight",
    "Law",
    "Path",
    "PolarLaw",
    "Reference",
    "SpeedLimits",
    "TrackingLaw",
    "Waypoints",
    "as_input",
    "brought_law",
    "delay_margin",
    "tracking_law",
]
