"""Progress of long work, on standard error."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
)

from laglab.scenario import Scenario


def progress_bar() -> Progress:
    """Ticks done of ticks to do, if that is known."""
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn(text_format_no_percentage=""),
        TextColumn("tick"),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        console=Console(stderr=True),
    )


@contextmanager
def progress_of(scenario: Scenario, shown: bool = True) -> Iterator[Callable[[int], None]]:
    """Shows the ticks that it is told of, if `shown`."""
    if not shown:
        yield lambda _: None
        return
    with progress_bar() as bar:
        task = bar.add_task(scenario.name, total=scenario.last_tick)
        yield lambda tick: bar.update(task, completed=tick)
