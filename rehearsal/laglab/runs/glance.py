"""A run at a glance, for whoever watches while it goes on by the clock."""

import math
from collections.abc import Callable, Iterable

import numpy as np
from msgspec import Struct

from laglab.scenario import Scenario
from laglab_gateway import (
    FOLLOWED,
    ArrivalRow,
    ClaimRow,
    FateKind,
    LinkRow,
    Recorder,
    Tapped,
    TraceRow,
)


class Glance(Struct, frozen=True):
    """What is known at a tick; None where nothing is."""

    rho: float | None
    """Distance to the goal, or to where the path wants it [m], as measured, or else as estimated,
    where the pose is not known."""
    sigma: float | None
    """Standard deviation that the station claims of the position [m]."""
    delays: tuple[int | None, int | None]
    """Of the last command and of the last measurement that came [ticks]."""
    lost: int | None
    """Messages, both ways, so far."""
    state: str
    """What the robot does: `waits` for its first command, `drives`, has `stopped` by itself."""


OnTick = Callable[[int, Glance | None], None]
"""Told now and then which tick is over, and how the run is where it goes by the clock."""


def watched(recorder: Recorder, scenario: Scenario) -> tuple[Recorder, Callable[[], Glance | None]]:
    """A recorder that tells the given one all, and a function that says how the run is; nothing in
    lock-step, where nobody could read it."""
    if scenario.pace != "realtime":
        return recorder, lambda: None
    glances = Glances(scenario)
    return Tapped(recorder, glances), glances.now


class Glances(Recorder):
    """Keeps the last of everything."""

    def __init__(self, scenario: Scenario) -> None:
        self._target = scenario.target
        self._patience = scenario.safety.link_timeout
        self._row: TraceRow | None = None
        self._claim: ClaimRow | None = None
        self._delays: dict[str, int] = {}
        self._followed: float | None = None
        self._lost = 0

    def row(self, row: TraceRow) -> None:
        self._row = row

    def claims(self, rows: Iterable[ClaimRow]) -> None:
        *_, self._claim = rows

    def arrivals(self, rows: Iterable[ArrivalRow]) -> None:
        for row in rows:
            self._delays[row.direction] = row.arrived - row.tick
            if row.direction == "command" and row.refused == FOLLOWED:
                self._followed = row.time

    def link(self, rows: Iterable[LinkRow]) -> None:
        self._lost += sum(row.fate != FateKind.DELIVERED for row in rows)

    def now(self, knows_losses: bool = True) -> Glance | None:
        """At the last tick; None before the first."""
        if self._row is None:
            return None
        return Glance(
            self._rho(self._row),
            math.sqrt(max(0.0, self._claim.p_xx + self._claim.p_yy)) if self._claim else None,
            (self._delays.get("command"), self._delays.get("measurement")),
            self._lost if knows_losses else None,
            self._state(self._row.time),
        )

    def _rho(self, row: TraceRow) -> float | None:
        for x, y in ((row.x, row.y), (row.x_meas, row.y_meas), (row.x_est, row.y_est)):
            if x is not None and y is not None:
                ((wanted_x, wanted_y, _),) = self._target.poses(np.array([float(row.tick)]))
                return math.hypot(x - wanted_x, y - wanted_y)
        return None

    def _state(self, time: float) -> str:
        if self._followed is None:
            return "waits"
        return "stopped" if time - self._followed >= self._patience else "drives"
