"""How far each station can be trusted."""

from laglab.studies.trust.report import Scores, draw_trust, score, trust_table
from laglab.studies.trust.trials import CONDITIONS, DEFAULT, Pair, stations, studies

__all__ = [
    "CONDITIONS",
    "DEFAULT",
    "Pair",
    "Scores",
    "draw_trust",
    "score",
    "stations",
    "studies",
    "trust_table",
]
