"""How consistent the filters are, as a table and as a picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from rich.table import Table

from laglab.results.figures import INCHES, Width, legend, line, printed, sheet
from laglab.results.figures.panels import marked
from laglab.results.figures.style import BLUE, GREY, PALE, short
from laglab.results.numbers import mean_of_known
from laglab.scenario import Scenario
from laglab.studies.consistency.over_seeds import CONFIDENCE, DEGREES, Average, Consistency
from laglab.tables import plain_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

AXES = ("x", "y", "θ")


def consistency_table(scenario: Scenario, filters: Sequence[Consistency], seeds: int) -> Table:
    """One line a filter."""
    low, high = filters[0].bounds
    table = plain_table(
        title=f"{scenario.name}: P_0 = {scenario.estimator.initial_covariance:g} I, n = "
        f"{scenario.link.n}, m = {scenario.link.m}, {seeds} seeds",
        caption="In the loop, over its link. Of a consistent filter NEES and\n"
        f"NIS average 3, here {low:.2f} to {high:.2f} (95 %); %: of ticks within.\n"
        "Ahead: NEES of the prediction by which the command was made.\n"
        "Worst: NEES of the worst run. x, y, θ: the standard deviation\n"
        "claimed, by the true one. P<0: of ticks. Lost: runs.",
    )
    headings = ("filter", "NEES", "%", "NIS", "%", "ahead", "worst", *AXES, "P<0", "lost", "")
    for heading in headings:
        table.add_column(heading, justify="left" if heading == "filter" else "right")
    for one in filters:
        table.add_row(one.estimator, *_cells(one))
    return table


def _cells(one: Consistency) -> list[str]:
    with np.errstate(all="ignore"):  # of a filter that diverges
        claimed, true = (np.sqrt(mean_of_known(v**2)) for v in (one.claimed, one.true))
    return [
        _told(one.nees.mean, ".2f"),
        _told(one.nees.inside, ".0%"),
        _told(one.nis.mean, ".2f"),
        _told(one.nis.inside, ".0%"),
        _told(one.nees_ahead.mean, ".2f"),
        _told(float(np.fmax.reduce(one.of_runs)), ".3g"),
        *(_told(ratio, ".2f") for ratio in claimed / true),
        _told(one.indefinite, ".0%"),
        str(one.diverged),
        "-" if unjudged(one) else "ok" if one.consistent else "no",
    ]


def _told(value: float, form: str) -> str:
    return "-" if np.isnan(value) else format(value, form)


def unjudged(one: Consistency) -> str | None:
    """Why a filter can be judged in part only; None: it can."""
    if np.isnan(one.claimed).all():
        return f"{one.estimator} claims nothing: there is nothing to judge it by"
    if not one.measured:
        return "no measurement ever arrived: there is no NIS"
    if np.isnan(one.nis.values).all():
        return f"{one.estimator} shows no innovation: there is no NIS"
    return None


def draw_consistency(
    scenario: Scenario, filters: Sequence[Consistency], width: Width = "two"
) -> Figure:
    """Average NEES, NIS and NEES of the prediction against their bounds, a panel a filter; and by
    how much each filter claims more, or less, than is true."""
    m = scenario.link.m
    ticks = np.arange(len(filters[0].nees.values)) + m
    time = np.asarray(ticks * scenario.sample_time, dtype=np.float64)
    with printed():
        figure = sheet(INCHES[width], 0.9 * len(filters) + 1.8)
        above, below = figure.subfigures(
            2, 1, squeeze=False, height_ratios=(len(filters), 1.3)
        ).flat
        panels = above.subplots(len(filters), 3, squeeze=False, sharex=True, sharey="col")
        for row, one in zip(panels, filters, strict=True):
            for axes, average in zip(row, _averages(one).values(), strict=True):
                _draw_average(axes, time, average, one.bounds)
            row[0].set_ylabel(short(one.estimator))
        for axes, name in zip(panels[0], _averages(filters[0]), strict=True):
            axes.set_title(name)
            _few_numbers(axes)
        for i, (axes, name) in enumerate(zip(below.subplots(1, 3), AXES, strict=True)):
            _draw_claims(axes, name, time, filters, i)
        legend(below.axes[0])
        figure.suptitle(
            f"{scenario.name}: is the claimed covariance the true one? Average of the seeds; grey: "
            f"{CONFIDENCE:.0%} of a consistent filter's"
            if width == "two"
            else scenario.name
        )
    return figure


def _averages(one: Consistency) -> dict[str, Average]:
    return {"NEES": one.nees, "NIS": one.nis, "NEES of x̂(k+n)": one.nees_ahead}


def _draw_average(
    axes: Axes, time: NDArray[np.float64], average: Average, bounds: tuple[float, float]
) -> None:
    axes.axhspan(*bounds, color=PALE, zorder=0.5)
    axes.axhline(DEGREES, color=GREY, linewidth=0.6, linestyle=":")
    axes.semilogy(time, average.values, color=BLUE, linewidth=0.6)


def _draw_claims(
    axes: Axes,
    name: str,
    time: NDArray[np.float64],
    filters: Sequence[Consistency],
    component: int,
) -> None:
    axes.axhline(1.0, color=GREY, linewidth=0.6, linestyle=":")
    axes.set_yscale("log")
    for number, one in enumerate(filters):
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = one.claimed[:, component] / one.true[:, component]
        marked(axes, time, ratio, line(number), number, one.estimator)
    _few_numbers(axes)
    axes.set(xlabel="t [s]", ylabel=f"σ of {name}:\nclaimed / true")


def _few_numbers(axes: Axes) -> None:
    """Beside the logarithmic axis: powers of ten, or plain numbers where there are not two of them.
    What matplotlib says in between them overlaps."""
    from matplotlib.ticker import MaxNLocator, NullFormatter, NullLocator

    axis = axes.yaxis
    axis.set_minor_formatter(NullFormatter())
    low, high = np.log10(axes.get_ylim())
    if np.floor(high) - np.ceil(low) < 1:
        axis.set_major_locator(MaxNLocator(4))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_locator(NullLocator())
