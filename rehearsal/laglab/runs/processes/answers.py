"""What a child of ours computes, answer by answer: both sides of it."""

import pickle
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from queue import Empty, Queue
from typing import Any

from msgspec import Struct

from laglab.errors import LaglabError
from laglab.runs.errors import SIDE_ERRORS
from laglab.runs.processes.child import Inbox, Tell, started
from laglab.runs.processes.reports import Computed, Ended, Failed


class NoAnswerError(LaglabError):
    """What somebody brought does not come back, or takes its process with it; the text says how."""

    exit_code = 1


class GaveUpError(LaglabError):
    """What somebody brought cannot be loaded, or not be made as told; the text says why."""

    exit_code = 2


@contextmanager
def asked(name: str, target: str, order: Struct, patience: float) -> Iterator[Callable[[], Any]]:
    """The function `target` in a process of its own, which calls `answer_all`; each call gives its
    next answer, for which it has `patience` [s].

    The calls raise NoAnswerError and GaveUpError.
    """
    inbox: Inbox = Queue()
    with started(name, target, order, inbox):
        yield lambda: _next(inbox, patience)


def _next(inbox: Inbox, patience: float) -> Any:
    try:
        report = inbox.get(timeout=patience).report
    except Empty:
        raise NoAnswerError(f"it did not answer within {patience:g} s") from None
    match report:
        case Computed(answer):
            return pickle.loads(answer)
        case Failed(reason):
            raise GaveUpError(reason)
        case Ended(how):
            raise NoAnswerError(how)
        case _:
            raise NoAnswerError("it said what is no answer")


def answer_all(tell: Tell, answers: Iterable[object]) -> None:
    """In the child: each, as it is computed; what fails on the way is told."""
    try:
        for answer in answers:
            tell(Computed(pickle.dumps(answer)))
    except (LaglabError, *SIDE_ERRORS) as error:
        tell(Failed(str(error), begun=True))
