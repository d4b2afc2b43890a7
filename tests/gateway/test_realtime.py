"""Ticks on the wall clock: no drift, lateness known, late answers counted from when they came."""

from collections.abc import Callable

import numpy as np
import pytest

from laglab_gateway import (
    Gateway,
    GatewayConfig,
    Outcome,
    Patience,
    Reading,
    Recorder,
    StationSilentError,
    Surroundings,
    TimingReport,
    TraceRow,
    serve_realtime,
)
from laglab_gateway.record.recorder import TimingRow
from laglab_protocol import (
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_HEARTBEAT,
    STATION_SYSTEM,
    Command,
    End,
    EndReason,
    Link,
    Listener,
    Message,
    Receiver,
    Sender,
    Tick,
)

PERIOD = 0.01


class StillPlant:
    """A robot that stays where it is: these tests are about time."""

    def read(self) -> Reading:
        return Reading(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

    def step(self, v: float, omega: float) -> None: ...

    def place(self, x: float, y: float, theta: float) -> None: ...


class SimulatedLink(Link):
    """A clock that only moves while somebody waits, and a station that takes its time to answer."""

    name = "simulated"
    datagrams = True

    def __init__(self, answer_time: Callable[[int], float], oversleep: Callable[[], float]) -> None:
        self.time = 1000.0
        self._answer_time = answer_time
        self._oversleep = oversleep
        self._sender = Sender(STATION_SYSTEM, STATION_COMPONENT)
        self._receiver = Receiver()
        hello = self._sender.frame(STATION_HEARTBEAT)
        self._inbox: list[tuple[float, bytes]] = [(self.time, hello)]

    def now(self) -> float:
        return self.time

    def fileno(self) -> int:
        return -1

    def send(self, data: bytes, _: object = None) -> None:
        for frame in self._receiver.receive(data):
            match frame.message:
                case Tick(tick=tick):
                    answer = Command(1.0 + tick, 0.0, tick, ROBOT_SYSTEM, ROBOT_COMPONENT, 0)
                    self._queue(self._answer_time(tick), answer)
                case End():
                    behind = max([self.time, *(at for at, _ in self._inbox)]) - self.time
                    self._queue(behind, frame.message)  # it reads in order

    def _queue(self, after: float, message: Message) -> None:
        self._inbox.append((self.time + after, self._sender.frame(message)))

    def receive(self, timeout: float) -> bytes:
        if self._inbox and self._inbox[0][0] <= self.time + timeout:
            at, data = self._inbox.pop(0)
            self.time = max(self.time, at)
            return data
        self.time += timeout + self._oversleep()
        return b""


class Kept(Recorder):
    def __init__(self) -> None:
        self.rows: list[TraceRow] = []
        self.timings: list[TimingRow] = []

    def row(self, row: TraceRow) -> None:
        self.rows.append(row)

    def timing(self, row: TimingRow) -> None:
        self.timings.append(row)


class SlowPlant(StillPlant):
    """Each step takes longer than a tick may."""

    def __init__(self, link: SimulatedLink) -> None:
        self._link = link

    def step(self, v: float, omega: float) -> None:
        del v, omega
        self._link.time += 5 * PERIOD


def run(
    link: SimulatedLink,
    n: int,
    last_tick: int,
    silence: float = 3.0,
    plant: StillPlant | None = None,
) -> tuple[Gateway, Kept, Outcome, TimingReport]:
    config = GatewayConfig(n, 0, last_tick, 0.01)
    gateway, kept = Gateway(plant or StillPlant(), config), Kept()
    listener = Listener(link, Receiver(), link.now)
    around = Surroundings(listener, kept, Patience(silence=silence), now=link.now)
    outcome, _, timing = serve_realtime(gateway, around, PERIOD)
    assert timing is not None
    return gateway, kept, outcome, timing


@pytest.mark.slow
@pytest.mark.timeout(180)  # a busy machine takes its time
def test_an_hour_of_ticks_does_not_drift() -> None:
    rng = np.random.default_rng(1)
    link = SimulatedLink(lambda _: 0.001, lambda: float(rng.exponential(2e-4)))
    ticks = 360_000
    _, kept, outcome, timing = run(link, 10, ticks)
    assert outcome == Outcome(EndReason.COMPLETED, ticks)
    late = np.array([row.lateness for row in kept.timings])
    assert link.time - 1000.0 == pytest.approx(3600.0, abs=0.02)
    assert late[-1000:].mean() == pytest.approx(late[:1000].mean(), abs=5e-5)
    assert timing.p50_s == pytest.approx(2e-4 * np.log(2), rel=0.1)
    assert timing.missed_deadlines == 0


def test_answers_in_time_make_the_trace_of_lockstep() -> None:
    gateway, kept, *_ = run(SimulatedLink(lambda _: 0.004, lambda: 0.0), 3, 50)
    assert [row.v for row in kept.rows] == [0.0] * 3 + [1.0 + k for k in range(48)]
    assert [row.v_sent for row in kept.rows] == [1.0 + k for k in range(51)]
    assert all(row.answer == pytest.approx(0.004) for row in kept.timings)
    assert gateway.audit.unanswered == 0


def test_without_a_delay_of_its_own_the_real_link_costs_one_tick() -> None:
    _, kept, *_ = run(SimulatedLink(lambda _: 0.004, lambda: 0.0), 0, 20)
    assert [row.v for row in kept.rows] == [0.0] + [1.0 + k for k in range(20)]


def test_an_answer_that_misses_its_tick_counts_from_when_it_came() -> None:
    gateway, kept, *_ = run(SimulatedLink(lambda _: 0.025, lambda: 0.0), 3, 60)
    assert [row.v_sent for row in kept.rows] == [None] * 61
    assert [row.v for row in kept.rows[5:]] == [1.0 + k for k in range(56)]
    assert gateway.audit.unanswered == 61
    measured = gateway.audit.command.report().measured
    assert measured is not None
    assert measured.mean == 5.0


def test_a_machine_that_cannot_keep_up_is_told_of() -> None:
    link = SimulatedLink(lambda _: 0.001, lambda: 0.015)
    _, kept, _, timing = run(link, 1, 100)
    assert timing.missed_deadlines > 40
    assert max(row.lateness for row in kept.timings) > PERIOD
    assert len(kept.rows) == 101


def test_a_station_that_answers_a_machine_far_behind_is_heard() -> None:
    link = SimulatedLink(lambda _: 0.0, lambda: 0.0)
    gateway, _, outcome, timing = run(link, 1, 100, plant=SlowPlant(link))
    assert outcome == Outcome(EndReason.COMPLETED, 100)
    assert timing.missed_deadlines == 100
    assert gateway.audit.unanswered == 0


@pytest.mark.parametrize("behind", [0.004, 0.3, 1.2])
def test_a_station_that_is_behind_hears_of_the_end(behind: float) -> None:
    gateway, *_ = run(SimulatedLink(lambda _: behind, lambda: 0.0), n=1, last_tick=300)
    assert gateway.station_end is not None


def test_a_silent_station_ends_the_run() -> None:
    link = SimulatedLink(lambda tick: 0.001 if tick < 50 else 1e9, lambda: 0.0)
    with pytest.raises(StationSilentError, match="since tick 49"):
        run(link, 1, 1000)
