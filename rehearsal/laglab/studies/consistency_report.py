"""The verdicts on the filters' covariances, as a table and as a picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from rich.table import Table

from laglab.results.figure import empty_figure
from laglab.scenario import Scenario
from laglab.studies.consistency import Average, Verdict, mean_of_known

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

AXES = ("x", "y", "θ")


def consistency_table(scenario: Scenario, verdicts: Sequence[Verdict], seeds: int) -> Table:
    """One line a filter."""
    low, high = verdicts[0].bounds
    table = Table(
        title=f"{scenario.name}: P_0 = {scenario.estimator.initial_covariance:g} I, n = "
        f"{scenario.link.command_delay}, m = {scenario.link.measurement_delay}, {seeds} seeds",
        caption="In the loop, over its link. Of a consistent filter NEES and\n"
        f"NIS average 3, here {low:.2f} to {high:.2f} (95 %); %: of ticks within.\n"
        "Ahead: NEES of the prediction by which the command was made.\n"
        "Worst: NEES of the worst run. x, y, θ: the standard deviation\n"
        "claimed, by the true one. P<0: of ticks. Lost: runs.",
        box=None,
        padding=(0, 1, 0, 0),
    )
    headings = ("filter", "NEES", "%", "NIS", "%", "ahead", "worst", *AXES, "P<0", "lost", "")
    for heading in headings:
        table.add_column(heading, justify="left" if heading == "filter" else "right")
    for verdict in verdicts:
        table.add_row(verdict.estimator, *_cells(verdict))
    return table


def _cells(verdict: Verdict) -> list[str]:
    claimed, true = (np.sqrt(mean_of_known(v**2)) for v in (verdict.claimed, verdict.true))
    return [
        f"{verdict.nees.mean:.2f}",
        f"{verdict.nees.inside:.0%}",
        f"{verdict.nis.mean:.2f}",
        f"{verdict.nis.inside:.0%}",
        f"{verdict.nees_ahead.mean:.2f}",
        f"{np.nanmax(verdict.of_runs, initial=0):.3g}",
        *(f"{ratio:.2f}" for ratio in claimed / true),
        f"{verdict.indefinite:.0%}",
        str(verdict.diverged),
        "ok" if verdict.consistent else "no",
    ]


def draw_consistency(scenario: Scenario, verdicts: Sequence[Verdict]) -> Figure:
    """Average NEES, NIS and NEES of the prediction against their bounds, a panel a filter; each
    run's own NEES; and claimed against true errors."""
    figure = empty_figure(13, 3 + 2.2 * len(verdicts))
    ticks = np.arange(len(verdicts[0].nees.values)) + scenario.link.measurement_delay
    time = np.asarray(ticks * scenario.sample_time, dtype=np.float64)
    rows = figure.subplots(len(verdicts) + 1, 3, squeeze=False)
    for panels, verdict in zip(rows, verdicts, strict=False):
        for axes, (name, average) in zip(panels, _averages(verdict).items(), strict=True):
            _draw_average(axes, f"{verdict.estimator}: {name}", time, average, verdict.bounds)
    for i, (panel, name) in enumerate(zip(rows[-1], AXES, strict=True)):
        _draw_errors(panel, f"error in {name}: true (full), claimed (dashed)", time, verdicts, i)
    rows[-1][0].legend(fontsize="small")
    figure.suptitle(f"{scenario.name}: is the claimed covariance the true one?")
    return figure


def _averages(verdict: Verdict) -> dict[str, Average]:
    return {"NEES": verdict.nees, "NIS": verdict.nis, "NEES of x̂_{k+n}": verdict.nees_ahead}


def _draw_average(
    axes: Axes,
    title: str,
    time: NDArray[np.float64],
    average: Average,
    bounds: tuple[float, float],
) -> None:
    axes.semilogy(time, average.values, linewidth=0.8)
    axes.axhspan(*bounds, color="grey", alpha=0.4)
    axes.set(xlabel="t [s]", title=title, ylim=(min(0.5, axes.get_ylim()[0]), None))
    axes.grid(alpha=0.3)


def _draw_errors(
    axes: Axes,
    title: str,
    time: NDArray[np.float64],
    verdicts: Sequence[Verdict],
    component: int,
) -> None:
    for verdict in verdicts:
        (line,) = axes.semilogy(time, verdict.true[:, component], label=verdict.estimator)
        claimed = verdict.claimed[:, component]
        axes.semilogy(time, claimed, linestyle="--", color=line.get_color())
    axes.set(xlabel="t [s]", title=title)
    axes.grid(alpha=0.3)
