"""Immutable records of what was, whose every version costs next to nothing."""

from laglab_control.past.history import History
from laglab_control.past.log import Log, append, cut, logged, newest_first
from laglab_control.past.memory import MEMORY
from laglab_control.past.sliding import SlidingProduct

__all__ = [
    "MEMORY",
    "History",
    "Log",
    "SlidingProduct",
    "append",
    "cut",
    "logged",
    "newest_first",
]
