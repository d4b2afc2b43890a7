"""How late to play out: the later, the fewer frames come too late, and the longer every delay."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.link.link_table import Bounds
from laglab.link.measured import Flow, MeasuredLink

ROUNDING = 1e-6
"""[ticks] What comes this little after a tick counts as on it: a clock tells no finer."""
LATE = (0.1, 0.05, 0.02, 0.01, 0.005, 0.001, 0.0)
"""Shares of late frames, of those that came, for which bounds are worth a thought."""


class Choice(NamedTuple):
    """One pair of bounds, and what it costs."""

    bounds: Bounds
    late: tuple[float, float]
    """Of the frames that came, the share that comes after the bound: commands, measurements."""
    unused: tuple[float, float]
    """Of all frames the share that is lost or late."""

    @property
    def total(self) -> int:
        """From a measurement to what the robot does of it [ticks]."""
        return sum(self.bounds)


def delay_in_ticks(flow: Flow, interval: float) -> NDArray[np.int_]:
    """Of the frames that came: after how many ticks each can be used."""
    return np.ceil(flow.delivered / interval - ROUNDING).astype(int)


def bound_for(flow: Flow, interval: float, late: float) -> int:
    """The least bound [ticks] by which no more than the share `late` of those that came is late."""
    ticks = np.sort(delay_in_ticks(flow, interval))
    if not len(ticks):
        return 0
    on_time = int(np.ceil((1 - late) * len(ticks) - ROUNDING))
    return int(ticks[max(on_time, 1) - 1])


def _choice(measured: MeasuredLink, bounds: Bounds) -> Choice:
    late, unused = [], []
    for (_, flow), bound in zip(measured.flows, bounds, strict=True):
        ticks = delay_in_ticks(flow, measured.interval)
        after = int(np.sum(ticks > bound))
        late.append(after / max(len(ticks), 1))
        unused.append((after + int(flow.lost.sum())) / max(len(flow.delay), 1))
    return Choice(bounds, (late[0], late[1]), (unused[0], unused[1]))


def suggested(measured: MeasuredLink, late: float) -> Choice:
    """The least bounds by which no more than the share `late` is late."""
    command, measurement = (bound_for(flow, measured.interval, late) for _, flow in measured.flows)
    return _choice(measured, Bounds(command, measurement))


def choices(measured: MeasuredLink) -> list[Choice]:
    """Some worth a thought, from the shortest delay to nothing late; each pair once."""
    found = {each.bounds: each for each in (suggested(measured, late) for late in LATE)}
    return list(found.values())
