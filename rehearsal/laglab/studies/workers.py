"""The seeds of a consistency test, shared out among processes of our own."""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from queue import Empty, Queue

import numpy as np
from msgspec import Struct

from laglab.errors import LaglabError, RunError
from laglab.runs.child import LOOK_UP, Inbox, Tell, started
from laglab.runs.errors import SIDE_ERRORS
from laglab.runs.reports import Computed, Ended, Failed
from laglab.scenario import Scenario
from laglab.studies.consistency import Sample, nth, sample


class Share(Struct, frozen=True):
    """A worker's seeds: of so many every `step`th, counted from `first`."""

    scenario: str
    """As TOML."""
    estimators: tuple[str, ...]
    first: int
    seeds: int
    step: int

    @property
    def numbers(self) -> range:
        """Of the seeds."""
        return range(self.first, self.seeds, self.step)


def samples(
    scenario: Scenario, estimators: Sequence[str], seeds: int, workers: int
) -> Iterator[dict[str, Sample]]:
    """Each seed's loop, and every filter on its record; in the order in which they are done.

    Raises: RunError, when a worker fails or dies.
    """
    inbox: Inbox = Queue()
    with ExitStack() as stack:
        waiting = {}
        for first in range(min(workers, seeds)):
            share = Share(scenario.to_toml(), tuple(estimators), first, seeds, workers)
            target = f"{judge.__module__}:{judge.__name__}"
            child = stack.enter_context(started(f"worker {first + 1}", target, share, inbox))
            waiting[child.name] = len(share.numbers)
        while any(waiting.values()):
            yield from _arrived(inbox, waiting)


def _arrived(inbox: Inbox, waiting: dict[str, int]) -> Iterator[dict[str, Sample]]:
    """What the next letter holds; counts it as no longer waited for."""
    try:
        child, report = inbox.get(timeout=LOOK_UP)
    except Empty:
        return
    match report:
        case Computed(tables):
            waiting[child.name] -= 1
            yield {name: _unpacked(table) for name, table in tables.items()}
        case Failed(reason):
            raise RunError(reason)
        case Ended(how) if waiting[child.name]:
            raise RunError(how)


def judge(share: Share, tell: Tell) -> None:
    """In the worker."""
    scenario = Scenario.from_toml(share.scenario)
    try:
        for number in share.numbers:
            judged = sample(nth(scenario, number), share.estimators)
            tell(Computed({name: _packed(one) for name, one in judged.items()}))
    except (LaglabError, *SIDE_ERRORS) as error:
        tell(Failed(str(error), begun=True))


def _packed(one: Sample) -> bytes:
    return np.column_stack(one).tobytes()


def _unpacked(table: bytes) -> Sample:
    columns = np.frombuffer(table).reshape(-1, 8)
    return Sample(columns[:, :3], columns[:, 3:6], columns[:, 6], columns[:, 7])
