"""The link you have: measured, imported, fitted; what a run then replays or rehearses on.

`probe` and `echo` measure it from its two ends, `read_link` reads what others measured; both give a
`MeasuredLink`, which `write_link_log` keeps as link.csv. `fit` makes a scenario's `[link]` of it.
"""

from laglab.link.advice import replaying, suggestions
from laglab.link.errors import LinkPlaceError
from laglab.link.figure import draw_fit
from laglab.link.fitting import fit
from laglab.link.importing import How, read_link, read_table
from laglab.link.link_table import FittedLink, link_toml
from laglab.link.measured import MeasuredLink, read_measured, write_link_log
from laglab.link.probing import ProbePlan, echo, probe, real_sizes
from laglab.link.scenario_of import scenario_toml
from laglab.link.told import choices_table, fit_table, print_measured

__all__ = [
    "FittedLink",
    "How",
    "LinkPlaceError",
    "MeasuredLink",
    "ProbePlan",
    "choices_table",
    "draw_fit",
    "echo",
    "fit",
    "fit_table",
    "link_toml",
    "print_measured",
    "probe",
    "read_link",
    "read_measured",
    "read_table",
    "real_sizes",
    "replaying",
    "scenario_toml",
    "suggestions",
    "write_link_log",
]
