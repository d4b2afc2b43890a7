"""The ways to live with a link, beside each other on the same links."""

from laglab.studies.rivals.report import draw_rivals, rivals_table, scores
from laglab.studies.rivals.trials import (
    LINKS,
    OWN_LINK,
    STRATEGIES,
    Fared,
    Trial,
    bounds,
    links_of,
    outcomes,
    trials,
    tried,
)

__all__ = [
    "LINKS",
    "OWN_LINK",
    "STRATEGIES",
    "Fared",
    "Trial",
    "bounds",
    "draw_rivals",
    "links_of",
    "outcomes",
    "rivals_table",
    "scores",
    "trials",
    "tried",
]
