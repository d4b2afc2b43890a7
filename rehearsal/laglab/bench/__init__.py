"""Benchmarks: ratios between things measured side by side in one run, never bare times.

A bench is dictionaries of contenders; the harness lets them take turns, and one report tells what
came out, as tables or as JSON.
"""

from laglab.bench.harness import Bench, Contest, Progress, Turn, Unit, microseconds, run, timed
from laglab.bench.result import Figure, Machine, Report, Result, Timing, this_machine
from laglab.bench.table import show

__all__ = [
    "Bench",
    "Contest",
    "Figure",
    "Machine",
    "Progress",
    "Report",
    "Result",
    "Timing",
    "Turn",
    "Unit",
    "microseconds",
    "run",
    "show",
    "this_machine",
    "timed",
]
