"""The jobs of a study, done by processes of our own, or by whoever else does jobs."""

import os
import pickle
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import ExitStack, suppress
from queue import Empty, Queue
from typing import Any, Protocol, Self, TypeVar

from msgspec import Struct

from laglab.errors import RunError, WorkerDiedError
from laglab.runs.processes.answers import answer_all
from laglab.runs.processes.child import LOOK_UP, Child, Inbox, Tell, started
from laglab.runs.processes.reports import Computed, Ended, Failed

Job = TypeVar("Job")
Answer = TypeVar("Answer")
MOST_DEATHS = 3
"""A job at which this many workers died is given up: it is likely to be the cause."""
SOON = 0.1
"""[s] How often a worker's thread looks whether all is over."""


class Executor(Protocol):
    """Whoever does jobs, such as those of `concurrent.futures`."""

    def submit(self, function: Callable[[Job], Answer], job: Job, /) -> "Future[Answer]":
        """Have it done."""


def cores() -> int:
    """Of this machine."""
    return os.cpu_count() or 1


class Call(Struct, frozen=True):
    """What a worker is told."""

    pickled: bytes
    """A function at the top of a module, and its argument."""


class _Asked:
    """A job that somebody waits for."""

    def __init__(self, function: Callable[[Any], Any], job: object) -> None:
        self.call = Call(pickle.dumps((function, job)))
        self.future: Future[Any] = Future()
        self.deaths = 0


class Processes:
    """An executor: children of ours, each kept as long as the context lasts.

    One that dies is replaced, and its job done again.
    """

    def __init__(self, workers: int) -> None:
        """So many; 0: one a core."""
        self._asked: Queue[_Asked] = Queue()
        self._over = threading.Event()
        self._threads = [
            threading.Thread(target=self._keep, args=(f"worker {number}",), daemon=True)
            for number in range(1, (workers or cores()) + 1)
        ]

    def __enter__(self) -> Self:
        for thread in self._threads:
            thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Ends the children, whatever they are at."""
        self._over.set()
        for thread in self._threads:
            thread.join()

    def submit(self, function: Callable[[Job], Answer], job: Job, /) -> "Future[Answer]":
        """Have it done by the next that is free."""
        asked = _Asked(function, job)
        self._asked.put(asked)
        return asked.future

    def _keep(self, name: str) -> None:
        """A worker's thread."""
        asked = self._next()
        while asked:
            inbox: Inbox = Queue()
            with ExitStack() as stack:
                worker = started(name, f"{__name__}:work", asked.call, inbox, again=True)
                try:
                    child = stack.enter_context(worker)
                except (OSError, RuntimeError) as error:  # no process, or no thread to read it
                    asked.future.set_exception(RunError(f"no worker can be started: {error}"))
                    asked = self._next()
                else:
                    asked = self._follow(child, inbox, asked)

    def _next(self) -> _Asked | None:
        while not self._over.is_set():
            with suppress(Empty):
                asked = self._asked.get(timeout=SOON)
                if asked.future.set_running_or_notify_cancel():
                    return asked
        return None

    def _follow(self, child: Child, inbox: Inbox, asked: _Asked) -> _Asked | None:
        """From job to job, as long as the child lives; what is then to be done by another."""
        while not self._over.is_set():
            try:
                _, report = inbox.get(timeout=SOON)
            except Empty:
                continue
            if isinstance(report, Ended) and not _given_up(asked, report.how):
                return asked
            match report:
                case Computed(answer):
                    _answer(asked.future, answer)
                case Failed(reason):
                    asked.future.set_exception(RunError(reason))
            following = self._next()
            if following is None or isinstance(report, Ended):
                return following
            asked = following
            child.order(asked.call)
        return None


def _answer(future: "Future[Any]", answer: bytes) -> None:
    try:
        future.set_result(pickle.loads(answer))
    except Exception as error:  # whatever it is made of may refuse to be made again
        future.set_exception(RunError(f"the answer of a job cannot be read: {error!r}"))


def _given_up(asked: _Asked, how: str) -> bool:
    asked.deaths += 1
    if asked.deaths < MOST_DEATHS:
        return False
    asked.future.set_exception(WorkerDiedError(f"{how}, three times at the same job"))
    return True


def work(call: Call, tell: Tell) -> None:
    """In the worker: one job."""
    answer_all(tell, _done(call))


def _done(call: Call) -> "Iterator[object]":
    function, job = pickle.loads(call.pickled)
    yield function(job)


def as_done(
    executor: Executor, function: Callable[[Job], Answer], jobs: Iterable[Job], ahead: int
) -> "Iterator[tuple[Job, Future[Answer]]]":
    """The jobs, in the order in which they are done; at most `ahead` are underway at once."""
    done: Queue[tuple[Job, Future[Answer]]] = Queue()
    underway = 0
    for job in jobs:
        future = _submitted(executor, function, job)
        future.add_done_callback(lambda future, job=job: done.put((job, future)))  # type: ignore[misc]
        underway += 1
        if underway == ahead:
            yield _first(done)
            underway -= 1
    for _ in range(underway):
        yield _first(done)


def _submitted(executor: Executor, function: Callable[[Job], Answer], job: Job) -> "Future[Answer]":
    """An executor that is shut down or broken says so here already: it is told with the answers."""
    try:
        return executor.submit(function, job)
    except Exception as error:  # whatever an executor may say
        refused: Future[Answer] = Future()
        refused.set_exception(error)
        return refused


def _first(done: "Queue[tuple[Job, Future[Answer]]]") -> "tuple[Job, Future[Answer]]":
    while True:
        with suppress(Empty):
            return done.get(timeout=LOOK_UP)


def shared_out(
    function: Callable[[Job], Answer], jobs: Sequence[Job], workers: int
) -> Iterator[Answer]:
    """The answers of processes of our own, in the order in which they are done.

    `function` stands at the top of a module; of `workers` 0 is one a core. Raises RunError, when a
    job fails, or kills whoever does it.
    """
    workers = max(1, min(workers or cores(), len(jobs)))
    with Processes(workers) as processes:
        for _, future in as_done(processes, function, jobs, ahead=2 * workers):
            yield future.result()
