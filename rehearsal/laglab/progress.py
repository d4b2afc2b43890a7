"""Progress of long work, on standard error."""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

from laglab.scenario import Scenario


def progress_bar() -> Progress:
    """Ticks done of ticks to do."""
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn(),
        TextColumn("tick {task.completed}/{task.total}"),
        TimeElapsedColumn(),
        console=Console(stderr=True),
    )


@contextmanager
def progress_of(scenario: Scenario, shown: bool = True) -> Iterator[Callable[[int], None]]:
    """Shows the ticks that it is told of, if `shown`."""
    if not shown:
        yield lambda _: None
        return
    total = None if math.isinf(scenario.last_tick) else scenario.last_tick
    with progress_bar() as bar:
        task = bar.add_task(scenario.name, total=total)
        yield lambda tick: bar.update(task, completed=tick)
