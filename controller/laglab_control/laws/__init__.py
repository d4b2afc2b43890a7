"""Control laws: a pose in, speeds out."""

from laglab_control.laws.aicardi import STAND_STILL, Drive, Law, as_input

__all__ = ["STAND_STILL", "Drive", "Law", "as_input"]
