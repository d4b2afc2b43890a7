"""What the commands that work off a study's cells have in common."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

from laglab.tables import say

if TYPE_CHECKING:
    from laglab.studies.workers import Executor

SchedulerOption = Annotated[
    str | None,
    typer.Option(metavar="URL", help="A dask scheduler, tcp://HOST:PORT; local: one of ours."),
]


def executor_of(scheduler: str | None, workers: int) -> "AbstractContextManager[Executor]":
    """Processes of our own, or a cluster's. Entering it raises: MissingExtraError, RefusedError."""
    from laglab.studies.sweep.cluster import OURS, cluster
    from laglab.studies.workers import Processes

    if workers and scheduler not in (None, OURS):
        raise typer.BadParameter("--workers: whoever runs the scheduler says how many it has")
    return Processes(workers) if scheduler is None else cluster(scheduler, workers)


@contextmanager
def kept_when_interrupted(runs: int, kept: Callable[[], int]) -> Iterator[None]:
    """Ctrl-C ends the work; how many of the runs are kept is said."""
    try:
        yield
    except KeyboardInterrupt:
        say(f"{kept()} of {runs} runs are kept: the same command goes on from there")
        raise
