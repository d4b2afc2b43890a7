"""What must be known besides the file."""

from pathlib import Path
from typing import NamedTuple

from laglab.link.probing import Sizes

TICK = 0.01
"""[s]"""


class How(NamedTuple):
    """How a file is to be read."""

    sizes: Sizes
    """[byte] Of a run's frames, where the file has others."""
    interval: float | None = None
    """[s] From tick to tick; None: as the file has it."""
    within: float | None = None
    """[s] So far the two machines' clocks agree; None: that is not known."""
    back: Path | None = None
    """The measurements' direction, where a file has only one."""


def halves(note: str) -> str:
    """What is said of a delay that is no more than half of a round trip."""
    return f"{note}: each way's delay is half of a round trip."


NOT_KNOWN_WHICH = (
    "A frame without an answer counts as a lost command: which way it was lost is not known."
)
