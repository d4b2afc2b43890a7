"""What must be known besides the file."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from laglab.link.measured import Array, Flow, MeasuredLink
from laglab.link.probing import Sizes
from laglab.link.resampling import known_everywhere

TICK = 0.01
"""[s]"""


class How(NamedTuple):
    """How a file is to be read."""

    sizes: Sizes
    """[byte] Of a run's frames, where the file has others."""
    interval: float | None = None
    """[s] From tick to tick; None: as the file has it."""
    within: float | None = None
    """[s] Within which the two machines' clocks agree; None: that is not known."""
    back: Path | None = None
    """The measurements' direction, where a file has only one."""


def by_halves(
    sent: Array, took: Array, interval: float, how: How, note: str, *more: str
) -> MeasuredLink:
    """The link by its round trips `took` [s], NaN where no answer came: half of each, each way."""
    lost = np.isnan(took)
    return MeasuredLink(
        Flow(sent, took / 2, how.sizes.command),
        Flow(sent, known_everywhere(took, np.zeros_like(lost)) / 2, how.sizes.measurement),
        interval,
        (note, *([NOT_KNOWN_WHICH] if lost.any() else []), *more),
    )


def halves(note: str) -> str:
    """What is said of a delay that is no more than half of a round trip."""
    return f"{note}: each way's delay is half of a round trip."


NOT_KNOWN_WHICH = (
    "A frame without an answer counts as a lost command: which way it was lost is not known."
)
