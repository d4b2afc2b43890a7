"""Estimates from the log of a session, beside each other and beside the true poses where known."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec
import numpy as np
from msgspec.structs import astuple
from numpy.typing import NDArray
from rich.table import Table

from laglab.results.columns import places
from laglab.results.figures import INCHES, Width, legend, line, printed, sheet
from laglab.results.figures.panels import (
    COMPONENTS,
    around,
    draw_measured,
    error_label,
    marked,
    symmetric,
)
from laglab.results.numbers import (
    AXES,
    VARIANCES,
    deviation,
    is_measured,
    rms_error,
    robot_pose,
)
from laglab.results.run import Kept, Run, open_run
from laglab.results.shadows import Shadow
from laglab.scenario import Scenario
from laglab.tables import plain_table
from laglab_gateway import ROWS, Trace
from laglab_protocol import Measurement
from laglab_station import SessionTick

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

UNITS = "[m, m, rad]"
Replays = Mapping[str, Shadow]


def estimates(replayed: Shadow) -> NDArray[np.float64]:
    """x̂, shape (ticks heard, 3)."""
    return np.stack([replayed[axis] for axis in AXES], axis=1)


def off(replayed: Shadow, trace: Trace) -> tuple[Shadow, NDArray[np.float64]]:
    """What was said of the ticks in the trace; the estimate less the pose there, (ticks, 3)."""
    there, rows = places(trace["tick"], replayed["tick"])
    said = {name: column[there] for name, column in replayed.items()}
    true = {name: column[rows] for name, column in trace.items()}
    return said, deviation(true, estimates(said))


def rms_deviation(replayed: Shadow, trace: Trace) -> list[float]:
    """Root mean square deviation from the true poses in x, y, θ; NaN where nothing was said."""
    errors = rms_error(off(replayed, trace)[1])
    return [np.nan] * 3 if errors is None else list(astuple(errors))


def replays_table(replays: Replays, trace: Trace | None) -> Table:
    """One line a filter: its last estimate; where there is a trace, its RMS deviation from the true
    poses, or from what was measured where those are not known."""
    table = plain_table()
    headings = ["filter", "ticks", f"x, y, θ at the end {UNITS}"]
    for heading in headings + ([_deviation_heading(trace)] if trace else []):
        table.add_column(heading)
    for name, replayed in replays.items():
        cells = [name, str(len(replayed["tick"])), _spelled(estimates(replayed)[-1].tolist())]
        table.add_row(*cells, *([_spelled(rms_deviation(replayed, trace))] if trace else []))
    return table


def _deviation_heading(trace: Trace) -> str:
    return f"RMS deviation {'from measured' if is_measured(trace) else 'in'} x, y, θ {UNITS}"


def replayed_run(directory: Path, replays: Replays) -> Run:
    """The run that left the log, with these estimators as its shadows.

    Raises: ResultsError, when the log stands without its run.
    """
    run = open_run(directory)
    tables = {name: run.table(name) for name in ROWS}
    estimator = run.scenario.estimator.model_copy(update={"compare": tuple(replays)})
    scenario = run.scenario.model_copy(update={"estimator": estimator})
    m = scenario.link.m
    others = {name: rms_error(off(each, run.trace)[1][m:]) for name, each in replays.items()}
    summary = run.summary
    compare = {summary.estimator: summary.rms_error, **others} if replays else {}
    summary = msgspec.structs.replace(summary, compare=compare)
    return Run(scenario, summary, directory, Kept(run.trace, tables, replays))


def _spelled(numbers: Sequence[float]) -> str:
    return ", ".join(f"{number:.3g}" for number in numbers)


def draw_replays(
    scenario: Scenario,
    session: Sequence[SessionTick],
    replays: Replays,
    trace: Trace | None,
    width: Width = "two",
) -> Figure:
    """Each component over time: measurements, estimates and, where known, the true pose; below
    what each estimate was off by from it, or else from what was measured, between ±2σ of what it
    claims."""
    rows = 2 if trace else 1
    with printed():
        figure = sheet(INCHES[width], 0.3 + 1.5 * rows if width == "two" else 1.2 * 3 * rows)
        grid = (rows, 3) if width == "two" else (3 * rows, 1)
        panels = figure.subplots(*grid, squeeze=False).ravel()
        sampled = [message for heard in session for message in heard.measurements]
        for i in range(3):
            _draw_estimates(panels[i], scenario, sampled, replays, trace, i)
            if trace:
                _draw_deviations(panels[3 + i], scenario, replays, trace, i)
        for axes in panels[:: len(panels) // rows]:
            legend(axes)
        figure.align_ylabels()
    return figure


def _draw_estimates(
    axes: Axes,
    scenario: Scenario,
    sampled: Sequence[Measurement],
    replays: Replays,
    trace: Trace | None,
    i: int,
) -> None:
    Ts = scenario.sample_time
    draw_measured(axes, [z.tick * Ts for z in sampled], [z.pose[i] for z in sampled])
    if trace and not is_measured(trace):
        axes.plot(trace["tick"] * Ts, robot_pose(trace)[:, i], "k:", zorder=3, label="true")
    for number, (name, replayed) in enumerate(replays.items()):
        time, values = replayed["tick"] * Ts, estimates(replayed)[:, i]
        marked(axes, time, values, line(number), number, name)
    if sampled:
        around(axes, np.array([z.pose[i] for z in sampled]))
    axes.set(xlabel="t [s]", ylabel=COMPONENTS[i])


def _draw_deviations(
    axes: Axes, scenario: Scenario, replays: Replays, trace: Trace, i: int
) -> None:
    errors, claims = [], []
    for number, replayed in enumerate(replays.values()):
        said, error = off(replayed, trace)
        time = said["tick"] * scenario.sample_time
        marked(axes, time, error[:, i], line(number), number, "")  # named above
        errors.append(error[:, i])
        two_sigma = 2 * np.sqrt(np.maximum(said[VARIANCES[i]], 0))
        claims.append(two_sigma)
        for edge, label in ((-two_sigma, ""), (two_sigma, "" if number else "±2σ claimed")):
            axes.plot(time, edge, color=line(number).color, linewidth=0.4, label=label)
    symmetric(axes, errors, np.concatenate(claims))
    axes.set(xlabel="t [s]", ylabel=error_label(i, is_measured(trace)))
