"""Runs that differ only in seed, start and what the link does: all at once, by the fleet FMU and a
batch of controllers."""

from laglab.studies.many.running import Ends, Ticks, is_ideal, run_many, why_one_by_one
from laglab.studies.many.schedule import schedule_of

__all__ = ["Ends", "Ticks", "is_ideal", "run_many", "schedule_of", "why_one_by_one"]
