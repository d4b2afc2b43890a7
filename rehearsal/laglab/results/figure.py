"""The paper's figures."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from laglab.errors import PlaceError
from laglab.results.numbers import (
    deviation,
    is_measured,
    loop_estimates,
    robot_pose,
    shadow_estimates,
)
from laglab.results.whole import whole_file
from laglab.results.writable import file_place
from laglab.scenario import Scenario
from laglab_gateway import Trace

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FIGURE_FILE = "figure.png"
DOTS_PER_INCH = 120


def empty_figure(width: float, height: float) -> Figure:
    """So many inches to draw on; matplotlib is loaded here, for a side alone does without."""
    from laglab.results.picture import Picture

    return Picture(figsize=(width, height), layout="constrained")


def draw(trace: Trace, scenario: Scenario, alarms: Sequence[int] = ()) -> Figure:
    """Three panels as in Figs. 4 to 7: path in the plane, heading, speeds; or as in Fig. 8, where
    estimators are compared. `alarms` are ticks to be marked."""
    if not scenario.estimator.compare:
        return draw_side_by_side([(trace, scenario, alarms)])
    deviations = {scenario.estimator.kind: deviation(trace, loop_estimates(trace))}
    for name in scenario.estimator.compare:
        deviations[name] = deviation(trace, shadow_estimates(trace, name))
    return draw_deviations(trace["time"], deviations, scenario)


def draw_side_by_side(runs: Sequence[tuple[Trace, Scenario, Sequence[int]]]) -> Figure:
    """The same three panels for each run, a row each."""
    figure = empty_figure(13, 4 * len(runs))
    rows = figure.subfigures(len(runs), 1, squeeze=False)[:, 0]
    for row, (trace, scenario, alarms) in zip(rows, runs, strict=True):
        plane, heading, speeds = row.subplots(1, 3)
        draw_path(plane, trace, scenario)
        draw_heading(heading, trace, scenario)
        draw_speeds(speeds, trace)
        mark_alarms((heading, speeds), [tick * scenario.sample_time for tick in alarms])
        row.suptitle(title(scenario))
    return figure


def title(scenario: Scenario) -> str:
    """The scenario in a line: name, filter, delays and noise."""
    return f"{scenario.name}: {scenario.gist}"


def draw_path(axes: Axes, trace: Trace, scenario: Scenario) -> None:
    """The robot's path, from its start to the goal's pose."""
    pose = robot_pose(trace)
    axes.plot(pose[:, 0], pose[:, 1], label="path")
    axes.plot(pose[0, 0], pose[0, 1], "o", label="start")
    x, y, _ = scenario.goal
    axes.plot(x, y, "*", markersize=12, label="goal")
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal", adjustable="datalim")
    axes.set_title("path" + _as_seen(trace))
    axes.legend()
    axes.grid(alpha=0.3)


def draw_heading(axes: Axes, trace: Trace, scenario: Scenario) -> None:
    """Heading over time, and the goal's."""
    axes.plot(trace["time"], robot_pose(trace)[:, 2])
    axes.axhline(scenario.goal[2], color="grey", linestyle=":", label="goal")
    axes.set(xlabel="t [s]", ylabel="θ [rad]", title="heading" + _as_seen(trace))
    axes.legend()
    axes.grid(alpha=0.3)


def _as_seen(trace: Trace) -> str:
    return ", as measured" if is_measured(trace) else ""


def draw_speeds(axes: Axes, trace: Trace) -> None:
    """The speeds in force over time."""
    axes.plot(trace["time"], trace["v"], label="v [m/s]")
    axes.plot(trace["time"], trace["omega"], label="ω [rad/s]")
    axes.set(xlabel="t [s]", title="speeds")
    axes.legend()
    axes.grid(alpha=0.3)


def mark_alarms(panels: Iterable[Axes], times: Sequence[float]) -> None:
    """A dashed line where the estimate was found to be wrong."""
    for axes in panels:
        for number, time in enumerate(times):
            label = None if number else "alarm"
            axes.axvline(time, color="C3", linestyle="--", linewidth=1, label=label)
        if times:
            axes.legend()


def draw_deviations(
    time: NDArray[np.float64], deviations: Mapping[str, NDArray[np.float64]], scenario: Scenario
) -> Figure:
    """Three panels as in Fig. 8: each filter's estimate less the pose, in x, y and θ."""
    figure = empty_figure(13, 4)
    labels = ("x [m]", "y [m]", "θ [rad]")
    for axis, (axes, label) in enumerate(zip(figure.subplots(1, 3), labels, strict=True)):
        for name, off in deviations.items():
            axes.plot(time, off[:, axis], label=name)
        axes.axhline(0.0, color="grey", linestyle=":")
        axes.set(xlabel="t [s]", title=f"deviation in {label}")
        axes.legend()
        axes.grid(alpha=0.3)
    figure.suptitle(f"{title(scenario)}: estimate less pose, all filters fed the same record")
    return figure


def save(figure: Figure, path: Path) -> None:
    """Write the figure in the format that the name's ending says. Raises ResultsError."""
    with whole_file(path) as file:
        figure.savefig(file, format=_format(path), dpi=DOTS_PER_INCH)


def picture_place(path: Path) -> Path:
    """Where `--out` wants a picture: it can be drawn there. Raises PlaceError."""
    known = empty_figure(1, 1).canvas.get_supported_filetypes()
    if _format(path) not in known:
        raise PlaceError(f"--out {path}: its name must end in one of {', '.join(known)}")
    return file_place("--out", path)


def _format(path: Path) -> str:
    return path.suffix[1:].lower()


def save_figure(draw_it: Callable[[], Figure], directory: Path) -> bool:
    """Draw a run's figure beside its other results; False where there is no matplotlib."""
    if find_spec("matplotlib") is None:
        return False
    save(draw_it(), directory / FIGURE_FILE)
    return True
