"""A study as one HTML file: its maps, to be zoomed, with every cell's numbers. Needs bokeh."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from bokeh.embed import components
from bokeh.model import Model
from bokeh.models import ColumnDataSource, FactorRange, HoverTool, LinearColorMapper
from bokeh.palettes import Cividis256
from bokeh.plotting import figure
from bokeh.transform import transform
from markupsafe import Markup

from laglab.files import write_whole
from laglab.results.report.page import (
    HERE,
    INSIDE,
    bokeh_scripts,
    made_by,
    policy_of,
    template,
    text_of,
)
from laglab.results.report.plots import dressed, heading
from laglab.studies.maps.drawing import telling, together
from laglab.studies.maps.grid import Field, Sorted, fields, sorted_into
from laglab.studies.maps.labels import in_cell, key_label, panel_label, value_label
from laglab.studies.maps.marks import ink
from laglab.studies.maps.measures import Interval, Measure
from laglab.studies.maps.reading import read_runs
from laglab.studies.maps.runs import Layout, StudyRuns, layout
from laglab.studies.sweep.loading import to_toml
from laglab.studies.sweep.study import Study

NOTHING = "#cccccc"
MOST_WRITTEN = 12
"""A map of more columns has no room for numbers in its cells."""


def save_study_page(study: Study, folder: Path, lines: Sequence[str], path: Path) -> None:
    """The page of what has been computed, with `lines` on how it went.

    Raises: ResultsError, StudyError, when there is nothing to draw along.
    """
    write_whole(path, _html(study, read_runs(folder), lines))


def _html(study: Study, runs: StudyRuns, lines: Sequence[str]) -> str:
    by = layout(runs)
    into = sorted_into(runs, by)
    maps: dict[str, Model] = {}
    rows: list[tuple[str, list[str]]] = []
    for each in telling(runs):
        names = [f"{each.of.column} {number}" for number in range(len(into.panels))]
        drawn = _maps(each.of, fields(each, into), by, into)
        maps |= dict(zip(names, drawn, strict=True))
        rows.append((each.of.label.replace("\n", " " if each.of.share else ", "), names))
    drawing, divs = components(maps)
    return template("laglab.studies.maps", "page.html").render(
        title=study.name,
        description=study.description,
        lines=[*lines, *together(by)],
        rows=[(label, [Markup(divs[name]) for name in names]) for label, names in rows],
        study=to_toml(study, study.origin),
        policy=policy_of(INSIDE),
        style=Markup(text_of(HERE, "page.css")),
        scripts=Markup("\n".join([*bokeh_scripts(), drawing])),
        made_by=made_by(),
    )


class _Scale(NamedTuple):
    """Of the colours of all panels of a measure: bright is good."""

    low: float
    high: float
    palette: Sequence[str]

    @property
    def mapper(self) -> LinearColorMapper:
        """As bokeh has it."""
        return LinearColorMapper(
            palette=list(self.palette), low=self.low, high=self.high, nan_color=NOTHING
        )

    def ink(self, value: float) -> str:
        """What is written on it."""
        place = (value - self.low) / (self.high - self.low) if self.high > self.low else 0.0
        last = len(self.palette) - 1
        colour = NOTHING if np.isnan(value) else self.palette[round(place * last)]
        red, green, blue = (int(colour[at : at + 2], 16) for at in (1, 3, 5))
        return ink(red / 255, green / 255, blue / 255)


def _maps(of: Measure, all_: Sequence[Field], by: Layout, into: Sorted) -> list[figure]:
    """A panel each, on one scale of colours."""
    known = np.concatenate([each.centre.ravel() for each in all_])
    known = known[np.isfinite(known)]
    ends = (0.0, 1.0) if of.share or not len(known) else (float(known.min()), float(known.max()))
    bright_is_good = Cividis256 if of.share and not of.bad else Cividis256[::-1]
    scale = _Scale(*ends, bright_is_good)
    drawn, written = [], len(into.x) <= MOST_WRITTEN
    for field, value in zip(all_, into.panels, strict=True):
        across = [value_label(x) for x in into.x]
        up = [value_label(y) if by.y else "" for y in into.y]
        plot = _plane(by, across, up, panel_label(by.panels, value))
        _fill(plot, _cells(field, across, up, of.share, scale), by, scale, written)
        drawn.append(plot)
    return drawn


def _plane(by: Layout, across: Sequence[str], up: Sequence[str], title: str) -> figure:
    plot = dressed(
        figure(
            title=heading(title),
            height=max(260, min(90 + 44 * len(up), 520)),
            sizing_mode="stretch_width",
            tools="pan,box_zoom,reset,save",
            x_range=FactorRange(factors=list(across)),
            y_range=FactorRange(factors=list(up)),
        )
    )
    plot.xaxis.axis_label = key_label(by.x)
    plot.yaxis.axis_label = key_label(by.y) if by.y else ""
    return plot


def _fill(
    plot: figure, cells: Mapping[str, object], by: Layout, scale: _Scale, written: bool
) -> None:
    source = ColumnDataSource(dict(cells))
    fill = transform("centre", scale.mapper)
    plot.rect("x", "y", 1, 1, source=source, fill_color=fill, line_color="white")
    if written:
        plot.text(
            "x",
            "y",
            "told",
            source=source,
            text_align="center",
            text_baseline="middle",
            text_font_size="11px",
            text_color="ink",
        )
    tips = [
        (key_label(by.x), "@x"),
        *([(key_label(by.y), "@y")] if by.y else []),
        ("median or share", "@centre{0.000}"),
        ("at 95 %", "@low{0.000} to @high{0.000}"),
        ("diverged", "@diverged{0 %}"),
    ]
    plot.add_tools(HoverTool(tooltips=tips))


def _cells(
    field: Field, across: Sequence[str], up: Sequence[str], share: bool, scale: _Scale
) -> Mapping[str, object]:
    """A row each."""
    centres, lows, highs = (of.ravel().tolist() for of in field[:3])
    estimates = map(Interval, centres, lows, highs)
    numbers = {name: of.ravel().astype(np.float32) for name, of in field._asdict().items()}
    return numbers | {
        "x": [*across] * len(up),
        "y": [each for each in up for _ in across],
        "told": [in_cell(each, share) for each in estimates],
        "ink": [scale.ink(each) for each in centres],
    }
