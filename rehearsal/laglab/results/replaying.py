"""Estimates from the log of a session, beside each other and beside the true poses where known."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from rich.table import Table

from laglab.results.columns import read_columns
from laglab.results.figure import empty_figure
from laglab.results.numbers import deviation
from laglab.results.run import Kept, Run, open_run
from laglab.results.shadows import Shadow
from laglab.scenario import Scenario
from laglab_gateway import ROWS, Trace
from laglab_station import SessionTick

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Replays = Mapping[str, Shadow]
AXES = ("x [m]", "y [m]", "θ [rad]")


def estimates(replayed: Shadow) -> NDArray[np.float64]:
    """x̂, shape (ticks heard, 3)."""
    return np.stack([replayed[axis] for axis in ("x", "y", "theta")], axis=1)


def rms_deviation(replayed: Shadow, trace: Trace) -> list[float]:
    """Root mean square deviation from the true poses in x, y, θ; NaN where nothing was said."""
    rows = np.searchsorted(trace["tick"], replayed["tick"])
    there = rows < len(trace["tick"])
    true = {name: column[rows[there]] for name, column in trace.items()}
    error = deviation(true, estimates(replayed)[there])
    if np.isnan(error).all():
        return [np.nan] * 3
    return [float(value) for value in np.sqrt(np.nanmean(error**2, axis=0))]


def replays_table(replays: Replays, trace: Trace | None) -> Table:
    """One line a filter: its last estimate; where the true poses are known, its RMS deviation."""
    table = Table(box=None, pad_edge=False)
    headings = ["filter", "ticks", "x, y, θ at the end"]
    for heading in headings + (["RMS deviation in x, y, θ"] if trace else []):
        table.add_column(heading)
    for name, replayed in replays.items():
        cells = [name, str(len(replayed["tick"])), _spelled(estimates(replayed)[-1].tolist())]
        table.add_row(*cells, *([_spelled(rms_deviation(replayed, trace))] if trace else []))
    return table


def replayed_run(directory: Path, replays: Replays) -> Run:
    """The run that left the log, with these estimators as its shadows.

    Raises: ResultsError, when the log stands without its run.
    """
    run = open_run(directory)
    tables = {name: read_columns(directory / name, kind) for name, kind in ROWS.items()}
    estimator = run.scenario.estimator.model_copy(update={"compare": tuple(replays)})
    scenario = run.scenario.model_copy(update={"estimator": estimator})
    return Run(scenario, run.summary, directory, Kept(run.trace, tables, replays))


def _spelled(numbers: Sequence[float]) -> str:
    return ", ".join(f"{number:.3g}" for number in numbers)


def draw_replays(
    scenario: Scenario, session: Sequence[SessionTick], replays: Replays, trace: Trace | None
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
            axes.plot(replayed["tick"] * Ts, estimates(replayed)[:, i], label=name)
        if trace:
            pose = trace[("x", "y", "theta")[i]]
            axes.plot(trace["time"], pose, "k:", label="true")
        axes.set(xlabel="t [s]", title=label)
        axes.grid(alpha=0.3)
    figure.axes[0].legend()
    return figure
