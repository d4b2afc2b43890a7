"""A report: runs that are over, in one HTML file."""

from collections.abc import Sequence
from pathlib import Path

from laglab.files import write_whole
from laglab.results.figures import labels, title
from laglab.results.link_view import link_view
from laglab.results.numbers import is_measured
from laglab.results.report.page import HERE, Page, Panel, html, text_of
from laglab.results.report.reading import tables_of
from laglab.results.run import Run
from laglab.results.summary import Summary
from laglab.results.table import summary_rows, warnings

MOST_ROWS = 12_000
"""Ticks, of all runs together: what a file of 4 MB has room for beside bokeh, as a rule."""
LARGEST = 4_000_000
"""[byte]"""
FEWEST = 200
"""Ticks of a run that are shown at least."""
MOST_RUNS = 8


def report_html(runs: Sequence[Run]) -> str:
    """One file that needs no other, and is no larger than LARGEST: where shadows and losses take
    room, with fewer ticks. Raises ResultsError."""
    most = MOST_ROWS // len(runs)
    while len((text := _html(runs, most)).encode()) > LARGEST and most > FEWEST:
        most //= 2
    return text


def _html(runs: Sequence[Run], most: int) -> str:
    names = labels(runs)
    panels = [_panel(run, name, most) for run, name in zip(runs, names, strict=True)]
    page = Page(
        title=" and ".join(names) if len(runs) > 1 else title(runs[0]),
        scripts=[text_of(HERE, "player.js")],
        rows=_compared(runs),
        duration=max(float(panel.tables.ticks["time"][-1]) for panel in panels),
    )
    return html(page, panels)


def save_report(runs: Sequence[Run], path: Path) -> None:
    """The same as a file. Raises ResultsError."""
    text = report_html(runs)
    write_whole(path, text)


def _panel(run: Run, name: str, most: int) -> Panel:
    view, summary = link_view(run), run.summary
    tables = tables_of(run, view, most)
    return Panel(
        name=name,
        scenario=run.scenario,
        tables=tables,
        measured=is_measured(run.drawn),
        timed=len(tables.timing["time"]) > 0,
        origin=_origin(summary, len(tables.ticks["tick"])),
        verdict=summary.verdict,
        mood="good" if summary.converged else "bad",
        notices=warnings(summary),
        quiet=view.outages,
    )


def _origin(summary: Summary, drawn: int) -> str:
    made = {
        "both": f"Both sides over {summary.transport}",
        "robot": f"The robot's side alone at {summary.transport}",
        "station": f"The station alone at {summary.transport}",
    }[summary.side]
    thinned = f"; {drawn} of {summary.ticks + 1} ticks are drawn" if drawn <= summary.ticks else ""
    versions = {"laglab": summary.laglab, **summary.versions}
    by = ", ".join(f"{name} {number}" for name, number in versions.items())
    return (
        f"{made}, plant {summary.plant}, seed {summary.seed}, by {by}{thinned}. "
        "The scenario below runs it again: laglab run FILE."
    )


def _compared(runs: Sequence[Run]) -> list[tuple[str, list[str]]]:
    """A row for each number of any of them, a cell for each run."""
    tables = [summary_rows(run) for run in runs]
    names = dict.fromkeys(name for table in tables for name in table)
    return [(name, [table.get(name, "") for table in tables]) for name in names]
