"""Knowing when an estimate is wrong."""

from laglab_control.guard.guard import Alarm, Guard, Watched

__all__ = ["Alarm", "Guard", "Watched"]
