"""The two sides as two processes, and the pipe on which each tells how it fares."""

import multiprocessing
import signal
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path
from time import monotonic
from typing import Any

from laglab.run.pauses import short_pauses
from laglab.run.robot_side import Setup, open_robot
from laglab.run.station_side import open_station, station_statistics
from laglab.scenario import Scenario
from laglab_fmu import FmuError
from laglab_gateway import FileRecorder, GatewayError, Outcome, Patience
from laglab_protocol import ProtocolError, open_endpoint
from laglab_station import StationError, run_station

SIDE_ERRORS = (FmuError, GatewayError, StationError, ProtocolError)
"""Everything that a side can say about itself in one line."""

REPORT_INTERVAL = 0.1


@dataclass(frozen=True)
class Listening:
    """The gateway waits for the station at this address."""

    address: str


@dataclass(frozen=True)
class Progress:
    """The gateway has finished this tick, so long after the first."""

    tick: int
    loop_seconds: float


@dataclass(frozen=True)
class Finished:
    """The gateway's run is over; the loop itself took this long."""

    outcome: Outcome
    loop_seconds: float
    statistics: dict[str, Any]


@dataclass(frozen=True)
class Answered:
    """The station's run is over, and what it says of it."""

    statistics: dict[str, Any]


@dataclass(frozen=True)
class Failed:
    """A side gave up, and why."""

    reason: str


Report = Listening | Progress | Finished | Answered | Failed


class LoopClock:
    """Passes progress on ten times a second, and times the loop from its first tick to its last."""

    def __init__(self, report: Callable[[int], None]) -> None:
        self._report = report
        self._first = self._last = self._told = 0.0

    def __call__(self, tick: int) -> None:
        self._last = monotonic()
        self._first = self._first or self._last
        if self._last - self._told > REPORT_INTERVAL:
            self._told = self._last
            self._report(tick)

    @property
    def seconds(self) -> float:
        """From the end of the first tick to the end of the last [s]."""
        return self._last - self._first


def gateway_process(
    scenario: Scenario, url: str, directory: Path, setup: Setup, reports: Connection
) -> None:
    """The robot's side, from opening the endpoint to the last report; SIGTERM ends it in order."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    clock = LoopClock(lambda tick: reports.send(Progress(tick, clock.seconds)))
    try:
        with (
            open_robot(scenario, setup) as serve,
            closing(FileRecorder(directory)) as recorder,
            open_endpoint(url) as endpoint,
            short_pauses(),
        ):
            reports.send(Listening(endpoint.name))
            patience = Patience(silence=scenario.silence_timeout, connect=30.0)
            outcome, statistics = serve(endpoint, recorder, patience, clock)
        reports.send(Finished(outcome, clock.seconds, statistics))
    except SIDE_ERRORS as error:
        reports.send(Failed(str(error)))


def station_process(scenario: Scenario, url: str, setup: Setup, reports: Connection) -> None:
    """The remote station's side."""
    try:
        with (
            open_endpoint(url) as endpoint,
            open_station(scenario, setup.key) as station,
            short_pauses(),
        ):
            run_station(station, endpoint, scenario.silence_timeout)
        reports.send(Answered(station_statistics(station)))
    except SIDE_ERRORS as error:
        reports.send(Failed(str(error)))


@dataclass(frozen=True)
class Side:
    """A running side: its name, its process and the pipe that its reports come from."""

    name: str
    process: BaseProcess
    reports: Connection

    def stop(self) -> None:
        """Ask the side to end in order."""
        self.process.terminate()

    def next_report(self) -> Report:
        """The next report; a pipe that ends without one is reported as a failure."""
        try:
            report: Report = self.reports.recv()
        except (EOFError, ConnectionError):
            self.process.join()
            return Failed(f"the {self.name} process {_how_it_ended(self.process.exitcode)}")
        return report


def _how_it_ended(exit_code: int | None) -> str:
    if exit_code is not None and exit_code < 0:
        return f"was killed by {signal.Signals(-exit_code).name}"
    return f"ended with exit code {exit_code} and no word"


@contextmanager
def _interrupts_ignored() -> Iterator[None]:
    """Children inherit this: a Ctrl-C in their terminal is for the parent, which ends them."""
    previous = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, previous)


@contextmanager
def started(name: str, target: Callable[..., None], *arguments: object) -> Iterator[Side]:
    """A side in a process of its own, gone when the context ends."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe(duplex=False)
    process = context.Process(target=target, args=(*arguments, theirs), name=name, daemon=True)
    with _interrupts_ignored():
        process.start()
    theirs.close()
    try:
        yield Side(name, process, ours)
    finally:
        process.join(timeout=1.0)
        if process.is_alive():
            process.kill()
            process.join()
        ours.close()
        process.close()
