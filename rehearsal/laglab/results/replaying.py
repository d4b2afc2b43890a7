"""Estimating again from the log of a session."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from rich.table import Table

from laglab.results.figure import empty_figure
from laglab.results.summary import deviation
from laglab.run.station_side import station_config
from laglab.scenario import Scenario, changed
from laglab_gateway import Trace
from laglab_station import Heard, Shadow, shadow

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Replays = Mapping[str, Shadow]
COLUMNS = ("tick", "x", "y", "theta", "p_xx", "p_xy", "p_xt", "p_yy", "p_yt", "p_tt")
AXES = ("x [m]", "y [m]", "θ [rad]")


def replay_session(scenario: Scenario, name: str, session: Sequence[Heard]) -> Shadow:
    """What the named filter makes of the session, with the scenario's model and prior.

    Raises: ScenarioError, when there is no such filter.
    """
    return shadow(station_config(changed(scenario, {"estimator.kind": name})), session)


def write_replays(replays: Replays, directory: Path) -> None:
    """One CSV file a filter, its numbers written so that they read back to the same doubles."""
    for name, replayed in replays.items():
        upper = replayed.covariances[:, *np.triu_indices(3)]
        with (directory / f"{name}.csv").open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(COLUMNS)
            for tick, x, P in zip(replayed.ticks, replayed.estimates, upper, strict=True):
                writer.writerow([int(tick), *x.tolist(), *P.tolist()])


def rms_deviation(replayed: Shadow, trace: Trace) -> list[float]:
    """Root mean square deviation from the true poses in x, y, θ; NaN where nothing was said."""
    error = deviation(_at(trace, replayed), replayed.estimates)
    if np.isnan(error).all():
        return [np.nan] * 3
    return [float(value) for value in np.sqrt(np.nanmean(error**2, axis=0))]


def _at(trace: Trace, replayed: Shadow) -> Trace:
    """The rows of the trace at the replay's ticks."""
    rows = np.searchsorted(trace["tick"], replayed.ticks)
    return {name: column[rows] for name, column in trace.items()}


def replays_table(replays: Replays, trace: Trace | None) -> Table:
    """One line a filter: its last estimate; where the true poses are known, its RMS deviation."""
    table = Table(box=None)
    headings = ["filter", "ticks", "x, y, θ at the end"]
    for heading in headings + (["RMS deviation in x, y, θ"] if trace else []):
        table.add_column(heading, no_wrap=True)
    for name, replayed in replays.items():
        cells = [name, str(len(replayed.ticks)), _spelled(replayed.estimates[-1])]
        table.add_row(*cells, *([_spelled(rms_deviation(replayed, trace))] if trace else []))
    return table


def _spelled(numbers: Sequence[float]) -> str:
    return ", ".join(f"{number:.3g}" for number in numbers)


def draw_replays(
    scenario: Scenario, session: Sequence[Heard], replays: Replays, trace: Trace | None
) -> Figure:
    """Each component over time: measurements, estimates and, where known, the true pose."""
    figure = empty_figure(13, 4)
    Ts = scenario.sample_time
    sampled = [message for heard in session for message in heard.measurements]
    times = [message.tick * Ts for message in sampled]
    for i, (axes, label) in enumerate(zip(figure.subplots(1, 3), AXES, strict=True)):
        measured = [message.pose[i] for message in sampled]
        axes.plot(times, measured, ".", markersize=1, label="measured")
        for name, replayed in replays.items():
            axes.plot(replayed.ticks * Ts, replayed.estimates[:, i], label=name)
        if trace:
            pose = trace[("x", "y", "theta")[i]]
            axes.plot(trace["time"], pose, "k:", label="true")
        axes.set(xlabel="t [s]", title=label)
        axes.grid(alpha=0.3)
    figure.axes[0].legend()
    return figure
