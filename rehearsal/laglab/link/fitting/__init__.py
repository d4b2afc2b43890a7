"""A link as a scenario has it, fitted to what was measured; and how late to play out."""

from laglab.link.fitting.bounds import Choice, bound_for, choices, delay_in_ticks, suggested
from laglab.link.fitting.delays import fit_delays
from laglab.link.fitting.fit import Fit, fit
from laglab.link.fitting.goodness import distance, simulated
from laglab.link.fitting.losses import fit_losses

__all__ = [
    "Choice",
    "Fit",
    "bound_for",
    "choices",
    "delay_in_ticks",
    "distance",
    "fit",
    "fit_delays",
    "fit_losses",
    "simulated",
    "suggested",
]
