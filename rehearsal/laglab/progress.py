"""Progress of long work, on standard error, where that is a terminal (or in a notebook).

Shown when there is something new, not by a thread of its own: that would take the loop's time at
any moment, and may hold a lock when Ctrl-C comes.
"""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TypeVar

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from laglab.scenario import Scenario

T = TypeVar("T")
PACE_WINDOW = 300.0
"""[s] A study's cells may take minutes each."""


@contextmanager
def progress_of(scenario: Scenario, shown: bool = True) -> Iterator[Callable[[int], None]]:
    """Shows the ticks that it is told of, if `shown`."""
    with _bar("tick", shown) as bar:
        task = bar.add_task(scenario.name, total=scenario.last_tick)
        yield lambda tick: bar.update(task, completed=tick, refresh=True)


def tracked(work: Iterable[T], total: int, title: str, unit: str) -> Iterator[T]:
    """The same, shown as it comes."""
    with _bar(unit) as bar:
        yield from bar.track(work, total=total, description=title)


@contextmanager
def progress_of_study(
    name: str, runs: int, cost: float, shown: bool = True
) -> Iterator[Callable[[int, float], None]]:
    """Shows the runs that it is told of, each time with what they cost: bar and time to go are by
    the cost, of which the last minutes tell how fast it goes."""
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TextColumn("run {task.fields[done]}/{task.fields[of]}", markup=False),
        TimeElapsedColumn(),
        TextColumn("to go"),
        TimeRemainingColumn(),
    )
    with _shown(*columns, shown=shown, window=PACE_WINDOW) as bar:
        task = bar.add_task(name, total=cost, done=0, of=runs)
        done = 0

        def told(some: int, theirs: float) -> None:
            nonlocal done
            done += some
            bar.update(task, advance=theirs, done=done, refresh=True)

        yield told


@contextmanager
def status() -> Iterator[Callable[[str], None]]:
    """Shows what is being done: the last that it was told. Gone at the end."""
    with _shown(TextColumn("{task.description}", markup=False), transient=True) as line:
        task = line.add_task("", total=None)
        yield lambda text: line.update(task, description=text, refresh=True)


def _bar(unit: str, shown: bool = True) -> Progress:
    """So many done of so many to do, if that is known."""
    return _shown(
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TaskProgressColumn(text_format_no_percentage=""),
        TextColumn(unit),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        shown=shown,
    )


def _shown(
    *columns: ProgressColumn, transient: bool = False, shown: bool = True, window: float = 30.0
) -> Progress:
    console = Console(stderr=True)
    return Progress(
        *columns,
        console=console,
        auto_refresh=False,
        transient=transient,
        speed_estimate_period=window,
        disable=not (shown and (console.is_terminal or console.is_jupyter)),
    )
