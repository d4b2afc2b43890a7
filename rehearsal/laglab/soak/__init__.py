"""The soak: random situations, real processes, and what is expected of every one of them."""

from laglab.soak.draw import draw, generator
from laglab.soak.expectations import EXPECTATIONS, failures
from laglab.soak.play import play
from laglab.soak.played import Part, Played, Sample
from laglab.soak.report import SCHEMA, Report, summary_tables, verdict
from laglab.soak.soak import Soak, repeated
from laglab.soak.system import require_processes
from laglab.soak.tally import Failures, Tally
from laglab.soak.turn import Blow, Turn

__all__ = [
    "EXPECTATIONS",
    "SCHEMA",
    "Blow",
    "Failures",
    "Part",
    "Played",
    "Report",
    "Sample",
    "Soak",
    "Tally",
    "Turn",
    "draw",
    "failures",
    "generator",
    "play",
    "repeated",
    "require_processes",
    "summary_tables",
    "verdict",
]
