"""A benchmark's report as tables, all in one style, within 80 columns."""

import math
from collections.abc import Sequence

from rich.console import Console
from rich.table import Table

from laglab.bench.result import Figure, Report, Result
from laglab.tables import plain_table

WIDTH = 80


def show(report: Report, console: Console) -> None:
    """A table for each contest, what else was found, and how it was measured."""
    tables = [_contest(result) for result in report.results]
    for table in [*tables, _figures(report.figures)] if report.figures else tables:
        console.print(table, width=WIDTH, crop=False)
        console.print()
    console.print(_how(report), width=WIDTH, highlight=False)


def _contest(result: Result) -> Table:
    """A row for each contender; a case is named where it begins."""
    table = plain_table("", "", title=result.title)
    for heading in (result.timings[0].unit, "in the median", f"× {result.yardstick}"):
        table.add_column(heading, justify="right", no_wrap=True)
    named = ""
    for timing in result.timings:
        case = "" if timing.case == named else timing.case
        numbers = (timing.fastest, timing.median, timing.ratio)
        table.add_row(case, timing.name, *map(significant, numbers))
        named = timing.case
    return table


def _figures(figures: Sequence[Figure]) -> Table:
    table = plain_table("", "", "", title="besides", headed=False)
    table.columns[1].justify = "right"
    for figure in figures:
        table.add_row(figure.name, significant(figure.value), figure.unit)
    return table


def _how(report: Report) -> str:
    machine = report.machine
    load = "" if machine.load is None else f", load {machine.load:.2f} before"
    return (
        f"of {report.rounds} rounds the fastest; Python {machine.python}, {machine.cpus} CPUs{load}"
    )


def significant(value: float) -> str:
    """With three significant digits, or all that stand before the point."""
    digits = 2 - math.floor(math.log10(abs(value))) if value else 0
    return f"{value:.{max(digits, 0)}f}"
