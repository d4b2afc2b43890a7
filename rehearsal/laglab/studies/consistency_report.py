"""The verdicts on the filters' covariances, as a table and as a picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from rich.table import Table

from laglab.results.figure import empty_figure
from laglab.scenario import Scenario
from laglab.studies.consistency import Verdict, mean_of_known

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
        caption=f"of a consistent filter NEES and NIS average 3, here {low:.2f} to {high:.2f} "
        "(95 %); % of ticks within; claimed : true standard deviation",
        box=None,
        pad_edge=False,
        collapse_padding=True,
    )
    headings = ("filter", "NEES", "%", "NIS", "%", *AXES, "P not > 0", "diverged", "consistent")
    for heading in headings:
        table.add_column(heading, justify="left" if heading == "filter" else "right")
    for verdict in verdicts:
        table.add_row(verdict.estimator, *_cells(verdict))
    return table


def _cells(verdict: Verdict) -> list[str]:
    m = verdict.measurement_delay
    claimed, true = (
        np.sqrt(mean_of_known(values[m:] ** 2)) for values in (verdict.claimed, verdict.true)
    )
    return [
        f"{verdict.mean(verdict.nees):.3g}",
        f"{verdict.inside(verdict.nees):.0%}",
        f"{verdict.mean(verdict.nis):.3g}",
        f"{verdict.inside(verdict.nis):.0%}",
        *(f"{ratio:.2f}" for ratio in claimed / true),
        f"{verdict.indefinite:.1%}",
        str(verdict.diverged),
        "yes" if verdict.consistent else "no",
    ]


def draw_consistency(scenario: Scenario, verdicts: Sequence[Verdict]) -> Figure:
    """Average NEES and NIS against their bounds, and claimed against true errors."""
    figure = empty_figure(13, 8)
    (nees, nis, x), (y, theta, _) = axes = figure.subplots(2, 3)
    axes[1, 2].axis("off")
    ticks = np.arange(len(verdicts[0].nees))
    time = np.asarray(ticks * scenario.sample_time, dtype=np.float64)
    _draw_averages(nees, "average NEES", time, {v.estimator: v.nees for v in verdicts}, verdicts[0])
    _draw_averages(nis, "average NIS", time, {v.estimator: v.nis for v in verdicts}, verdicts[0])
    for i, (panel, name) in enumerate(zip((x, y, theta), AXES, strict=True)):
        _draw_errors(panel, f"error in {name}: true (full), claimed (dashed)", time, verdicts, i)
    axes[1, 2].legend(*nees.get_legend_handles_labels(), loc="center")
    figure.suptitle(f"{scenario.name}: is the claimed covariance the true one?")
    return figure


def _draw_averages(
    axes: Axes,
    title: str,
    time: NDArray[np.float64],
    averages: dict[str, NDArray[np.float64]],
    verdict: Verdict,
) -> None:
    for name, values in averages.items():
        axes.semilogy(time, values, label=name, linewidth=0.8)
    axes.axhspan(*verdict.bounds, color="grey", alpha=0.3, label="95 % bounds")
    axes.set(xlabel="t [s]", title=title)
    axes.grid(alpha=0.3)


def _draw_errors(
    axes: Axes,
    title: str,
    time: NDArray[np.float64],
    verdicts: Sequence[Verdict],
    component: int,
) -> None:
    for verdict in verdicts:
        (line,) = axes.semilogy(time, verdict.true[:, component])
        claimed = verdict.claimed[:, component]
        axes.semilogy(time, claimed, linestyle="--", color=line.get_color())
    axes.set(xlabel="t [s]", title=title)
    axes.grid(alpha=0.3)
