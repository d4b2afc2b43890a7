"""Measuring a link: frames of the real sizes at the real rate, both ways, with clocks in each."""

from laglab.link.probing.clocks import Clocks, seen_by_clocks
from laglab.link.probing.echo import echo
from laglab.link.probing.ends import ProbeEnd, Prober
from laglab.link.probing.probe import ProbePlan, probe
from laglab.link.probing.sizes import Sizes, real_sizes

__all__ = [
    "Clocks",
    "ProbeEnd",
    "ProbePlan",
    "Prober",
    "Sizes",
    "echo",
    "probe",
    "real_sizes",
    "seen_by_clocks",
]
