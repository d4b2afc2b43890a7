"""Scenarios: what a run is about, whole, in a TOML file."""

from laglab.scenario.model import LinkScenario, Scenario, load, shipped

__all__ = ["LinkScenario", "Scenario", "load", "shipped"]
