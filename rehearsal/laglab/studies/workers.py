"""The jobs of a study, shared out among processes of our own."""

import importlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from queue import Empty, Queue
from typing import Any, NamedTuple, TypeVar, get_type_hints

import msgspec
from msgspec import Raw, Struct

from laglab.errors import LaglabError, RunError
from laglab.runs.child import LOOK_UP, Inbox, Tell, started
from laglab.runs.errors import SIDE_ERRORS
from laglab.runs.reports import Computed, Ended, Failed

Job = TypeVar("Job", bound=Struct)
Answer = TypeVar("Answer", bound=Struct)


class Share(Struct, frozen=True):
    """A worker's part of the jobs."""

    function: str
    """MODULE:FUNCTION, which does one."""
    jobs: list[Raw]


class _Kinds(NamedTuple):
    """What a function that does jobs takes and gives."""

    job: type
    answer: type

    @classmethod
    def of(cls, function: Callable[[Any], Any]) -> "_Kinds":
        hints = get_type_hints(function)
        answer = hints.pop("return")
        (job,) = hints.values()
        return cls(job, answer)


def shared_out(
    function: Callable[[Job], Answer], jobs: Sequence[Job], workers: int
) -> Iterator[Answer]:
    """The answers, in the order in which they are done.

    `function` stands at the top of a module. Raises RunError, when a worker fails or dies.
    """
    inbox: Inbox = Queue()
    kind = _Kinds.of(function).answer
    target = f"{function.__module__}:{function.__qualname__}"
    with ExitStack() as stack:
        waiting = {}
        for first in range(min(workers, len(jobs))):
            share = Share(target, [Raw(msgspec.json.encode(job)) for job in jobs[first::workers]])
            name = f"worker {first + 1}"
            stack.enter_context(started(name, f"{__name__}:work", share, inbox))
            waiting[name] = len(share.jobs)
        while any(waiting.values()):
            for answer in _arrived(inbox, waiting):
                yield msgspec.json.decode(answer, type=kind)


def _arrived(inbox: Inbox, waiting: dict[str, int]) -> Iterator[Raw]:
    """What the next letter holds; counts it as no longer waited for."""
    try:
        child, report = inbox.get(timeout=LOOK_UP)
    except Empty:
        return
    match report:
        case Computed(answer):
            waiting[child.name] -= 1
            yield answer
        case Failed(reason):
            raise RunError(reason)
        case Ended(how) if waiting[child.name]:
            raise RunError(how)


def work(share: Share, tell: Tell) -> None:
    """In the worker."""
    module, _, name = share.function.partition(":")
    function = getattr(importlib.import_module(module), name)
    kind = _Kinds.of(function).job
    try:
        for job in share.jobs:
            answer = function(msgspec.json.decode(job, type=kind))
            tell(Computed(Raw(msgspec.json.encode(answer))))
    except (LaglabError, *SIDE_ERRORS) as error:
        tell(Failed(str(error), begun=True))
