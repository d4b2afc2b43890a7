"""Progress of long work, on standard error, where that is a terminal (or in a notebook).

Shown when there is something new, not by a thread of its own: that would take the loop's time at
any moment, and may hold a lock when Ctrl-C comes.
"""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from math import inf
from typing import TypeVar

from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.text import Text

from laglab.runs.glance import Glance, OnTick
from laglab.scenario import Scenario
from laglab.tables import say, terminal

T = TypeVar("T")
PACE_WINDOW = 300.0
"""[s] A study's cells may take minutes each."""

REFRESHED = 0.1
"""[s] Nothing is shown sooner after the last: to show it takes time from the work."""

LOGGED = 60.0
"""[s] Between two lines, where nothing can be shown in place."""

ROOMY, NARROW = 72, 44
"""[columns] Narrower terminals are told less."""


@contextmanager
def progress_of(scenario: Scenario, shown: bool = True) -> Iterator[OnTick]:
    """Shows the ticks that it is told of, if `shown`; of a run by the clock how it is."""
    with _bar("tick", shown) as bar:
        task = bar.add_task(scenario.name, total=scenario.last_tick, glance="")

        def told(tick: int, glance: Glance | None = None) -> None:
            if glance is not None:
                bar.columns = (TextColumn("{task.fields[glance]}", markup=False),)
                line = at_a_glance(scenario, tick, glance, bar.console.width)
                bar.update(task, glance=line)
            bar.update(task, completed=tick, refresh=True)

        yield told


def at_a_glance(scenario: Scenario, tick: int, glance: Glance, width: int) -> str:
    """In one line of at most `width` columns: what matters less is left out first."""
    of = "" if scenario.last_tick is None else f" of {scenario.duration:g}"
    delays = ", ".join("?" if each is None else str(each) for each in glance.delays)
    parts = [
        (0, scenario.name),
        (1, f"{tick * scenario.sample_time:.1f}{of} s"),
        (0, "ρ ?" if glance.rho is None else f"ρ {glance.rho:.3g} m"),
        (3, "" if glance.sigma is None else f"σ {glance.sigma:.2g} m"),
        (2, f"delays {delays}"),
        (2, "" if glance.lost is None else f"lost {glance.lost}"),
        (0, glance.state),
    ]
    for least in (3, 2, 1, 0):
        line = "  ".join(text for weight, text in parts if text and weight <= least)
        if len(line) < width:
            return line
    return line[: width - 1]


def tracked(work: Iterable[T], total: int, title: str, unit: str) -> Iterator[T]:
    """The same, shown as it comes."""
    with _bar(unit) as bar:
        in_lines = _Lines(title, total, bar)
        for done, each in enumerate(bar.track(work, total=total, description=title), start=1):
            yield each
            in_lines.told(done)


@contextmanager
def passing(title: str, seconds: float) -> Iterator[Callable[[float], None]]:
    """Shows how much of a given time is over, as it is told [s]."""
    with _bar("s") as bar:
        task = bar.add_task(title, total=round(seconds))
        yield lambda elapsed: bar.update(task, completed=round(elapsed), refresh=True)


@contextmanager
def counting(unit: str, title: str, total: int) -> Iterator[Callable[[int], None]]:
    """Shows how many are done, about ten times a second at most."""
    with _bar(unit) as bar:
        task = bar.add_task(title, total=total)
        shown = 0.0

        def told(done: int) -> None:
            nonlocal shown
            now = bar.get_time()
            if now - shown >= REFRESHED or done == total:
                shown = now
                bar.update(task, completed=done, refresh=True)

        yield told


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
        in_lines = _Lines(name, runs, bar, shown)
        done = 0

        def told(some: int, theirs: float) -> None:
            nonlocal done
            done += some
            bar.update(task, advance=theirs, done=done, refresh=True)
            in_lines.told(done)

        yield told


class _Lines:
    """What a bar tells, for a log: a line now and then."""

    def __init__(self, title: str, total: int, bar: Progress, shown: bool = True) -> None:
        self._title, self._total = title, total
        self._now = bar.get_time
        self._next = self._now() + LOGGED if shown and bar.disable else inf

    def told(self, done: int) -> None:
        """So many are."""
        if self._now() >= self._next and done < self._total:
            self._next = self._now() + LOGGED
            say(f"{self._title}: {done} of {self._total}")


@contextmanager
def status() -> Iterator[Callable[[str], None]]:
    """Shows what is being done: the last that it was told. Gone at the end."""
    with _shown(TextColumn("{task.description}", markup=False), transient=True) as line:
        task = line.add_task("", total=None)
        yield lambda text: line.update(task, description=text, refresh=True)


class Rate(ProgressColumn):
    """How much is done per second."""

    def __init__(self, unit: str) -> None:
        super().__init__()
        self._unit = unit

    def render(self, task: Task) -> Text:
        speed = task.finished_speed or task.speed
        if speed is None and task.elapsed:  # nothing but the end was told
            speed = task.completed / task.elapsed
        if not speed:
            return Text()
        digits = f"{speed:.0f}" if speed >= 100 else f"{speed:.2g}"
        return Text(f"{digits} {self._unit}/s")


class ToGo(TimeRemainingColumn):
    """How long it will still take."""

    def render(self, task: Task) -> Text:
        left = super().render(task)
        return Text("") if task.total is None or task.finished else left + Text(" to go")


def _bar(unit: str, shown: bool = True) -> Progress:
    """How much is done, of how much if that is known; how fast, and how long it will still take."""
    name, done = TextColumn("{task.description}", markup=False), MofNCompleteColumn()
    share = TaskProgressColumn(text_format_no_percentage="")
    width = terminal(stderr=True).width
    if width < NARROW:
        return _shown(name, share, shown=shown)
    if width < ROOMY:
        return _shown(name, share, done, ToGo(compact=True), shown=shown)
    return _shown(
        name,
        BarColumn(16),
        share,
        done,
        Rate(unit),
        ToGo(compact=True),
        shown=shown,
    )


def _shown(
    *columns: ProgressColumn, transient: bool = False, shown: bool = True, window: float = 30.0
) -> Progress:
    console = terminal(stderr=True)
    return Progress(
        *columns,
        console=console,
        auto_refresh=False,
        transient=transient,
        speed_estimate_period=window,
        redirect_stdout=False,  # what is printed meanwhile goes where it was told to
        disable=not (shown and (console.is_terminal or console.is_jupyter)),
    )
