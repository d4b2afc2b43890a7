"""A robot that is told ahead what to do: by the drive alone, and by the gateway."""

import math
from collections.abc import Iterable, Iterator, Sequence

import pytest

from laglab_gateway import (
    Gateway,
    GatewayConfig,
    LinkRow,
    Reading,
    RecordedFates,
    Safety,
    TraceRow,
)
from laglab_gateway.drive import (
    Drive,
    Mode,
    Rejection,
    follow_plan,
    rejection,
    speeds,
    supervise,
)
from laglab_protocol import (
    NO_COMMAND,
    STATION_COMPONENT,
    STATION_SYSTEM,
    Command,
    Measurement,
    Message,
    Planned,
    Sender,
    frames_in,
)

TS = 0.01
N = 3


def plan_of(tick: int, length: int, n: int = N) -> Planned:
    """Entry i is v = tick + i/1000."""
    following = tuple((tick + i / 1000, 0.0) for i in range(1, length + 1))
    return Planned(Command(float(tick), 0.0, tick, 1, 1, 0, length), tick + n, following)


@pytest.mark.parametrize("accepted", [13, 15])
def test_the_drive_reads_its_plan_off_and_then_holds_its_last_entry(accepted: int) -> None:
    drive, safety = follow_plan(plan_of(10, 5), accepted), Safety()
    got = [speeds(supervise(drive, k, TS, safety), k, TS, safety)[0] for k in range(accepted, 21)]
    assert got == [10 + min(k - 13, 5) / 1000 for k in range(accepted, 21)]


def test_the_failsafes_time_runs_from_where_the_plan_has_run_out() -> None:
    drive, safety = follow_plan(plan_of(10, 40), 13), Safety(link_timeout=0.1, ramp=0.1)
    modes = [supervise(drive, k, TS, safety).mode for k in range(13, 80)]
    assert modes.index(Mode.STOPPING) == 40 + 10
    stopping = supervise(drive, 13 + 50, TS, safety)
    assert speeds(stopping, 13 + 55, TS, safety)[0] == pytest.approx(10.04 / 2)


def test_a_plan_that_has_run_out_before_it_came_is_held_like_a_command() -> None:
    drive = follow_plan(plan_of(10, 5), 30)
    assert (drive.fresh, speeds(drive, 30, TS, Safety())) == (30, (10.005, 0.0))


@pytest.mark.parametrize(
    ("bad", "why"),
    [(math.nan, Rejection.NOT_FINITE), (99.0, Rejection.OUT_OF_LIMITS), (1.0, None)],
)
def test_one_bad_entry_refuses_all(bad: float, why: Rejection | None) -> None:
    command, following = Command(0.0, 0.0, 9, 1, 1, 0, 2), ((0.0, 0.0), (bad, 0.0))
    assert rejection(Drive(), command, Safety(v_limit=2.0), following) is why


class Still:
    """A plant that keeps what it was told."""

    def __init__(self) -> None:
        self.driven: list[float] = []

    def read(self) -> Reading:
        return Reading(*(0.0,) * 6, *(0.0,) * 2)

    def step(self, v: float, omega: float) -> None:
        del omega
        self.driven.append(v)

    def place(self, x: float, y: float, theta: float) -> None:
        raise AssertionError((x, y, theta))


class Rig:
    """A gateway, and a station that says what the test says; some frames of commands are lost,
    or late: by the tick they enter in, and their number in it."""

    def __init__(
        self,
        lost: Iterable[tuple[int, int]] = (),
        late: Iterable[tuple[int, int, int]] = (),
        **config: int,
    ) -> None:
        rows = [LinkRow("command", tick, frame, 0, 0, "lost", 0.0) for tick, frame in lost]
        rows += [
            LinkRow("command", tick, frame, 0, 0, "delivered", ticks * TS)
            for tick, frame, ticks in late
        ]
        self.plant = Still()
        settings = GatewayConfig(N, 0, 10**6, TS, **config)
        self.gateway = Gateway(self.plant, settings, {"command": RecordedFates(rows, range(10**6))})
        self.sender = Sender(STATION_SYSTEM, STATION_COMPONENT)
        self.echoed: list[int] = []

    def tick(self, *messages: Message) -> TraceRow:
        for frame in frames_in(b"".join(self.gateway.open_tick())):
            if isinstance(frame.message, Measurement):
                self.echoed.append(frame.message.command_tick)
        self.gateway.settle()
        self.gateway.hear(frames_in(b"".join(map(self.sender.frame, messages))))
        return self.gateway.close_tick()

    def run(self, ticks: int, length: int) -> list[float]:
        """v in force, when each tick is answered with a plan of that length."""
        rows = [self.tick(*said(plan_of(k, length))) for k in range(ticks)]
        return [row.v or 0.0 for row in rows]


def said(plan: Planned) -> Sequence[Message]:
    frames = plan.frames()
    return [*frames, Command(*plan.command.speeds, plan.tick, 1, 1, 0, len(plan[2]))]


def newest(ticks: int, lost: set[int], length: int) -> Iterator[float]:
    """By the definition: at j, of the newest plan k that has come, entry j - n - k."""
    for j in range(ticks):
        come = [k for k in range(j - N + 1) if k not in lost]
        yield come[-1] + min(j - N - come[-1], length) / 1000 if come else 0.0


@pytest.mark.parametrize("length", [1, 5, 15, 16, 40])
def test_at_each_tick_the_newest_plans_entry_for_it_is_in_force(length: int) -> None:
    lost = {5, 6, 7, *range(20, 40), 44, 46, 48}
    # what belongs to one plan: the command is frame 0, the parts of the plan follow
    rig = Rig(lost=[(tick, tick % 2) for tick in lost])
    assert rig.run(70, length) == list(newest(70, lost, length))
    stamps = [k for k in range(67) if k not in lost]
    assert set(rig.echoed) == {NO_COMMAND, *stamps[:-1]}
    assert rig.gateway.audit.report().refused == {}


def test_a_plan_of_which_a_frame_is_lost_is_counted_when_it_is_past() -> None:
    rig = Rig(lost=[(5, 2), (6, 0), (7, 1)])
    rig.run(90, 30)
    assert rig.gateway.audit.report().refused == {"incomplete": 2}


def test_a_plan_whose_command_never_came_does_not_go_with_the_next() -> None:
    rig = Rig()
    rig.tick(plan_of(0, 5).frames()[0])
    rig.tick(*said(plan_of(1, 5)))
    sent = [row for row in rig.gateway.take_link_rows() if row.direction == "command"]
    assert [(row.tick, row.frame) for row in sent] == [(1, 0), (1, 1)]


def test_a_plan_that_is_late_is_read_from_where_it_should_be() -> None:
    rig = Rig(lost=[(k, 0) for k in range(6, 12)], late=[(5, 0, 4), (5, 1, 2)])
    got = rig.run(13, 9)
    assert got[7:12] == [4.0, 4.001, 4.002, 4.003, 4.004]
    assert got[12] == 5.004


def test_an_older_plan_is_never_returned_to() -> None:
    rig = Rig(lost=[(k, 0) for k in range(7, 30)], late=[(5, 0, 6), (5, 1, 6)])
    got = rig.run(20, 2)
    assert got[9:] == [6.0, 6.001, *[6.002] * 9]
    assert rig.gateway.audit.report().refused == {"stale": 1}


def test_a_plan_that_is_early_waits_while_the_last_one_goes_on() -> None:
    rig = Rig()
    for k in range(4):
        rig.tick(*said(plan_of(k, 9)))
    got = [rig.tick(*said(plan_of(4, 9, n=8))).v, rig.tick(*said(plan_of(5, 9, n=6))).v]
    got += [rig.tick().v for _ in range(8)]
    assert got == [1.0, 2.0, 3.0, 3.001, 3.002, 3.003, 3.004, 5.0, 5.001, 5.002]


def test_played_out_a_plan_is_held_whole_and_dropped_whole() -> None:
    rig = Rig(late=[(5, 1, 3), (8, 1, 2), (9, 0, 2), (10, 0, 3)], command_playout=N + 2)
    got = rig.run(20, 12)
    shown = [plan_of(k, 12) for k in range(15)]
    late = {5, 10}
    for j in range(N + 2, 20):
        k = max(k for k in range(j - N - 1) if k not in late)
        assert got[j] == shown[k].following[j - N - k - 1][0]
    assert rig.gateway.audit.report().refused == {"late": 2}


def test_an_answer_of_which_a_frame_was_lost_before_the_link_waits_for_the_repeat() -> None:
    rig = Rig()
    rig.gateway.open_tick()
    *frames, command = said(plan_of(0, 30))
    for messages in ([frames[0], command], [frames[1], command]):
        rig.gateway.hear(frames_in(b"".join(map(rig.sender.frame, messages))))
        assert not rig.gateway.answered
    rig.gateway.hear(frames_in(b"".join(map(rig.sender.frame, [*frames, command]))))
    assert rig.gateway.answered


@pytest.mark.parametrize("between", [0, 1, 2])
def test_a_plan_on_a_slow_line_may_cross_the_border_of_a_tick(between: int) -> None:
    """What there is of an answer when a tick ends belongs to the rest, which comes in the next."""
    rig, answer = Rig(), said(plan_of(0, 30))
    rig.tick(*answer[:between])
    rig.tick(*answer[between:])
    got = [rig.tick().v for _ in range(8)]
    assert got[-1] == plan_of(0, 30).following[9 - N - 1][0]
    assert rig.gateway.audit.report().refused == {}
