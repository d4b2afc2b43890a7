"""Control laws: a pose in, speeds out."""

from laglab_control.laws.aicardi import STAND_STILL, Demand, Law, as_input
from laglab_control.laws.margin import DelayMargin, delay_margin

__all__ = ["STAND_STILL", "DelayMargin", "Demand", "Law", "as_input", "delay_margin"]
