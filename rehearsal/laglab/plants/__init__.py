"""Somebody's robot, looked at before a run: what could be mapped, and how it behaves.

`proposed` reads a map of names out of an FMU, `tried` drives a scenario's plant in a process of its
own and says what it did.
"""

from laglab.plants.proposal import Proposal, proposed
from laglab.plants.trial import Trial, tried

__all__ = ["Proposal", "Trial", "proposed", "tried"]
