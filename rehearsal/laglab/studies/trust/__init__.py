"""How far each station can be trusted."""

from laglab.studies.trust.report import draw_trust, scores, trust_table
from laglab.studies.trust.trials import CONDITIONS, DEFAULT, Fared, Trial, fared, stations

__all__ = [
    "CONDITIONS",
    "DEFAULT",
    "Fared",
    "Trial",
    "draw_trust",
    "fared",
    "scores",
    "stations",
    "trust_table",
]
