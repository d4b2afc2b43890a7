"""Runs in this process that keep nothing on disk: for what needs many of them."""

from collections.abc import Callable

import numpy as np

from laglab.run.inline import InlineEndpoint
from laglab.run.robot_side import open_gateway, serve
from laglab.run.station_side import station_config
from laglab.scenario import Scenario
from laglab_control import Controller, StationConfig
from laglab_gateway import NoRecorder, Patience, Trace, TraceRow
from laglab_station import Station


class _TraceKeeper(NoRecorder):
    """A recorder that keeps the rows in memory."""

    def __init__(self) -> None:
        self.rows: list[TraceRow] = []

    def row(self, row: TraceRow) -> None:
        """Keep it."""
        self.rows.append(row)


def run_trial(
    scenario: Scenario, controller: Callable[[StationConfig], Controller] = Controller
) -> Trace:
    """The scenario's trace, up to the tick at which it ended.

    Raises: ScenarioError, when it would not end by itself.
    """
    scenario.must_end()
    keeper = _TraceKeeper()
    endpoint = InlineEndpoint(Station(station_config(scenario), controller))
    with open_gateway(scenario) as gateway:
        serve(scenario, gateway, endpoint, keeper, Patience(), lambda _: None)
    columns = np.array(keeper.rows, dtype=np.float64).T
    return dict(zip(TraceRow._fields, columns, strict=True))


def completed(trace: Trace, scenario: Scenario) -> bool:
    """Whether the trial went on to its last tick: it ends before when the estimate diverges."""
    return int(trace["tick"][-1]) == scenario.must_end()
