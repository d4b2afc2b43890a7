"""Control laws: a pose in, speeds out."""

from laglab_control.laws.aicardi import STAND_STILL, Demand, Law, as_input

__all__ = ["STAND_STILL", "Demand", "Law", "as_input"]
