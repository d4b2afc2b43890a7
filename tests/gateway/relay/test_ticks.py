"""The relay's core: the robot's ticks, the link's delays and fates, and how a run ends."""

import numpy as np
import pytest

from laglab_gateway import (
    Event,
    ExtraDelay,
    GatewayConfig,
    Impairments,
    Outcome,
    RandomFates,
    Relay,
    Safety,
    Services,
    standard_parameters,
)
from laglab_protocol import (
    MAV_SEVERITY_ERROR,
    ROBOT_COMPONENT,
    STATION_COMPONENT,
    STATION_SYSTEM,
    Applied,
    Command,
    End,
    EndReason,
    Heartbeat,
    Recall,
    Receiver,
    Sender,
    Settings,
    Tick,
)

from .rig import TS, Rig, Robot, relay


def fates_of(event: Event) -> RandomFates:
    return RandomFates(Impairments(), [event], np.random.default_rng(1))


@pytest.mark.parametrize("first", [0, 5000])
@pytest.mark.parametrize(("n", "m"), [(1, 0), (1, 1), (10, 20), (25, 3)])
def test_both_delays_are_exact_by_the_robots_own_word(n: int, m: int, first: int) -> None:
    rig = Rig(relay(n, m), first)
    rig.run(60)
    for k, told in enumerate(rig.told):
        *measurements, tick = told
        assert tick == Tick(first + k, len(measurements))
        assert [z.tick for z in measurements] == ([first + k - m] if k >= m else [])
    for k, row in enumerate(rig.rows):
        assert (row.tick, row.time) == (first + k, k * TS)
        assert row[2:8] == (None, None, None, first + k, -(first + k) / 2, (first + k) / 8)
        assert row.v == ((first + k - n) / 1000 if k >= n else 0.0)
    report = rig.relay.audit.report()
    for direction, delay in (("command", n), ("measurement", m)):
        assert getattr(report, direction).measured.min == delay
        assert getattr(report, direction).measured.max == delay


@pytest.mark.parametrize("first", [0, 5000])
def test_in_front_of_a_robot_commands_are_played_out_here(first: int) -> None:
    jitter = Impairments(extra_delay=ExtraDelay("uniform", 0.03, 0.03))  # up to 6 ticks
    services = Services(standard_parameters(2, 0, Safety()), placeable=False)
    config = GatewayConfig(2, 0, 10**6, TS, command_playout=6)
    fates = RandomFates(jitter, [], np.random.default_rng(1))
    rig = Rig(Relay(config, services, {"command": fates}), first)
    rig.run(200)
    late = {row.tick for row in rig.relay.take_link_rows() if row.fate == "late"}
    assert 20 < len(late) < 100  # a third
    held = 0.0
    for k, row in enumerate(rig.rows):
        if k >= 6 and k - 6 not in late:
            held = (first + k - 6) / 1000
        assert row.v == held
    assert rig.relay.told_robot.command_playout == 0
    assert rig.relay.settings.command_playout == 6
    assert rig.relay.audit.report().refused["late"] == pytest.approx(len(late), abs=6)


def test_with_n_zero_a_command_is_in_force_at_the_robots_next_tick() -> None:
    rig = Rig(relay(0, 0))
    rig.run(30)
    assert [row.v for row in rig.rows] == [0.0] + [k / 1000 for k in range(28)]


def test_the_run_ends_so_many_ticks_after_its_first() -> None:
    rig = Rig(relay(1, 1, last_tick=30), first=700)
    rig.run(40)
    assert rig.relay.outcome == Outcome(EndReason.COMPLETED, 730)
    assert [row.tick for row in rig.rows][:31] == list(range(700, 731))


def test_a_tick_that_lost_a_frame_is_passed_over() -> None:
    rig = Rig(relay())
    rig.run(3)
    damaged = bytearray(rig.robot.tick())
    damaged[20] ^= 1
    rig.feed(bytes(damaged))
    rig.run(2)
    assert [row.tick for row in rig.rows] == [0, 1, 2, 4]
    assert rig.rows[2].v is None, "the sample that would tell was lost"


def test_what_the_station_missed_is_asked_of_the_robot_and_told() -> None:
    """Also what the relay itself has not heard: a robot that remembers tells it with its tick."""
    rig = Rig(relay(1, 1))
    rig.run(30)
    for _ in range(4):
        rig.robot.tick()  # these are lost before they reach us
    for _ in range(3):
        rig.run(5)
        rig.feed(rig.robot.tick())
        rig.say(Recall(28, 8, 1, 1), Command(0.0, 0.0, rig.relay.tick, 1, 1, 1))
        rig.forward()
    rig.run(4)
    ticks = [told[-1].tick for told in rig.told if isinstance(told[-1], Tick)]
    assert ticks == [*range(30), *range(34, 56)], "no tick that tells of it is passed over"
    told = [each for batch in rig.told for each in batch if isinstance(each, Applied)]
    assert told[-1].first == 28
    assert told[-1].v[2:5] == (0.25, 0.25, 0.25), "by the robot's own word"


def test_several_ticks_in_one_piece_are_ticks_one_by_one() -> None:
    rig = Rig(relay(2, 1))
    rig.feed(rig.robot.tick() + rig.robot.tick() + rig.robot.tick())
    assert [told[-1] for told in rig.told] == [Tick(0, 0), Tick(1, 1), Tick(2, 1)]


def test_a_robot_that_begins_again_brings_nothing_out_of_order() -> None:
    """Its stamps are small again; the time of the run goes on."""
    rig = Rig(relay(2, 1))
    rig.run(40)
    rig.robot = Robot()
    rig.run(40)
    assert [row.tick for row in rig.rows] == [*range(40), *range(20 - 1, 40 - 1)]
    assert [row.time for row in rig.rows] == pytest.approx(np.arange(60) * TS)
    report = rig.relay.audit.report()
    assert (report.command.reordered, report.measurement.reordered) == (0, 0)
    said = [(each.severity, each.text) for each in rig.relay.take_notices()]
    assert (MAV_SEVERITY_ERROR, b"the robot has begun again") in said, "nobody may overlook it"


def test_what_a_robot_did_before_it_began_again_is_nobodys_answer() -> None:
    rig = Rig(relay(1, 0))
    rig.run(60)
    rig.robot = Robot()
    rig.run(30)
    for _ in range(3):
        rig.feed(rig.robot.tick())
        rig.say(Recall(40, 4, 1, 1), Command(0.0, 0.0, rig.relay.tick, 1, 1, 1))
        rig.forward()
        rig.run(3)
    told = [each for batch in rig.told for each in batch if isinstance(each, Applied)]
    assert {each.v[0] for each in told} == {0.25}, "by the robot's own word"


def test_a_command_overtaken_on_the_link_is_stale() -> None:
    held_back = Impairments(reorder=1.0, reorder_by=0.05)
    rig = Rig(relay(commands=fates_of(Event(0.0, 0.01, held_back))))
    rig.run(10)
    assert [row.v for row in rig.rows] == [0.0, 0.0] + [k / 1000 for k in range(1, 8)]
    assert rig.relay.audit.report().refused == {"stale": 1}


def test_the_links_timeline_goes_by_the_runs_time_not_the_robots() -> None:
    outage = Event(0.1, 0.05, Impairments(loss=1.0))
    rig = Rig(relay(commands=fates_of(outage)), first=3000)
    rig.run(30)
    lost = [row.tick for row in rig.relay.take_link_rows() if row.fate == "lost"]
    assert lost == list(range(10, 15))
    assert rig.relay.audit.report().command.lost == {"lost": 5}


def test_the_stations_end_is_the_outcome_at_the_robots_next_tick() -> None:
    rig = Rig(relay())
    rig.run(5)
    rig.say(End(4, EndReason.DIVERGED))
    rig.feed(rig.robot.tick())
    assert rig.relay.outcome == Outcome(EndReason.DIVERGED, 4)


@pytest.mark.parametrize(
    ("said", "meant"), [(EndReason.INTERRUPTED, EndReason.INTERRUPTED), (77, EndReason.FAILED)]
)
def test_the_robots_end_is_the_outcome_at_once(said: int, meant: EndReason) -> None:
    rig = Rig(relay())
    rig.run(5)
    rig.feed(rig.robot.sender.frame(End(4, said)))
    assert rig.relay.outcome == Outcome(meant, 4)


def test_only_the_robot_itself_is_heard() -> None:
    rig = Rig(relay())
    stranger = Sender(7, ROBOT_COMPONENT)
    rig.feed(stranger.frame(Tick(0, 0)) + stranger.frame(End(0, 0)))
    assert not rig.relay.under_way
    assert rig.relay.outcome is None


def test_the_robot_is_greeted_and_ended_as_by_its_station() -> None:
    settings, greeting = Receiver().receive(relay().greeting())
    (end,) = Receiver().receive(relay().end_of_robot(EndReason.FAILED))
    assert isinstance(greeting.message, Heartbeat)
    assert isinstance(settings.message, Settings)
    assert end.message == End(0, EndReason.FAILED)
    for frame in (greeting, end):
        assert (frame.system, frame.component) == (STATION_SYSTEM, STATION_COMPONENT)
