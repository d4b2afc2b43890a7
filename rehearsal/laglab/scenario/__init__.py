"""Scenarios: what a run is about, whole, in a TOML file of nested tables."""

from laglab.scenario.loading import changed, load, shipped, shipped_names
from laglab.scenario.model import Scenario
from laglab.scenario.overrides import Overrides, assignment, both_ways
from laglab.scenario.target import Target
from laglab.scenario.timeline_file import read_timeline

__all__ = [
    "Overrides",
    "Scenario",
    "Target",
    "assignment",
    "both_ways",
    "changed",
    "load",
    "read_timeline",
    "shipped",
    "shipped_names",
]
