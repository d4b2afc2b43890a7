"""One direction of the link: exact when ideal; seeded, recorded and repeatable when not."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_gateway import (
    Burst,
    Channel,
    Event,
    ExtraDelay,
    FileRecorder,
    Impairments,
    RandomFates,
    RecordedFates,
    first_tick,
    read_link_log,
)
from laglab_gateway.link.timeline import in_force
from laglab_protocol import Command

TS = 0.01


def command(tick: int) -> Command:
    return Command(0.1 * tick, -0.2, tick, 1, 1, 0)


def channel(link: Impairments, delay: int = 0, seed: int = 1, *events: Event) -> Channel[Command]:
    fates = RandomFates(link, events, np.random.default_rng(seed))
    return Channel("command", delay, TS, fates)


def cross(line: Channel[Command], ticks: int, more: int = 100) -> list[tuple[int, int]]:
    """(stamp, tick of arrival) of all that came out."""
    out = []
    for tick in range(ticks + more):
        if tick < ticks:
            line.push(tick, command(tick))
        out += [(message.tick, tick) for message in line.due(tick)]
    return out


@given(delay=st.integers(0, 50), ticks=st.integers(1, 120))
def test_an_ideal_channel_is_exact(delay: int, ticks: int) -> None:
    line: Channel[Command] = Channel("command", delay, TS)
    assert cross(line, ticks) == [(tick, tick + delay) for tick in range(ticks)]
    assert line.take_log() == []


def test_a_negative_delay_is_refused() -> None:
    with pytest.raises(ValueError, match="0 or more"):
        Channel("command", -1, TS)


@given(seed=st.integers(0, 2**31))
def test_the_same_seed_gives_the_same_link(seed: int) -> None:
    link = Impairments(
        extra_delay=ExtraDelay("normal", 0.03, 0.02),
        loss=0.1,
        burst=Burst(0.05, 0.3),
        reorder=0.1,
        duplicate=0.1,
        bit_error_rate=1e-4,
        bandwidth=57_600,
    )
    lines = [channel(link, 5, seed) for _ in range(2)]
    assert cross(lines[0], 50) == cross(lines[1], 50)
    assert lines[0].take_log() == lines[1].take_log()


def fates(line: Channel[Command]) -> Counter[str]:
    return Counter(row.fate for row in line.take_log())


def test_loss_is_as_frequent_as_told() -> None:
    line = channel(Impairments(loss=0.2))
    cross(line, 5000, 0)
    assert fates(line)["lost"] == pytest.approx(1000, abs=4 * np.sqrt(5000 * 0.2 * 0.8))


def test_bursts_lose_in_runs_of_the_length_told() -> None:
    line = channel(Impairments(burst=Burst(good_to_bad=0.02, bad_to_good=0.25)))
    cross(line, 20_000, 0)
    lost = np.array([row.fate == "burst" for row in line.take_log()])
    runs = int((np.diff(lost.astype(int)) == 1).sum())
    assert lost.mean() == pytest.approx(0.02 / 0.27, rel=0.15)
    assert lost.sum() / runs == pytest.approx(4.0, rel=0.15)


def test_extra_delay_comes_on_top_of_the_fixed_one() -> None:
    arrived = cross(channel(Impairments(extra_delay=ExtraDelay("uniform", 0.05, 0.03)), 7), 2000)
    late = np.array([tick - stamp - 7 for stamp, tick in arrived])
    assert len(arrived) == 2000
    assert late.min() == 3
    assert late.max() == 8
    assert late.mean() == pytest.approx(5.5, abs=0.1)


def test_a_frame_held_back_is_overtaken() -> None:
    arrived = cross(channel(Impairments(reorder=0.1, reorder_by=0.03)), 500)
    stamps = [stamp for stamp, _ in arrived]
    assert sorted(stamps) == list(range(500))
    assert stamps != sorted(stamps)
    assert {tick - stamp for stamp, tick in arrived} == {0, 3}


def test_duplicates_come_twice() -> None:
    stamps = Counter(stamp for stamp, _ in cross(channel(Impairments(duplicate=0.3)), 500))
    assert set(stamps.values()) == {1, 2}
    assert sum(stamps.values()) == pytest.approx(650, abs=45)


def test_bit_errors_lose_what_the_crc_catches() -> None:
    line = channel(Impairments(bit_error_rate=1e-3))
    arrived = cross(line, 1000)
    log = line.take_log()
    told = Counter(row.fate for row in log)
    bits = 8 * log[-1].size
    assert told["corrupted"] == pytest.approx(1000 * (1 - 0.999**bits), rel=0.2)
    assert len(arrived) == told["delivered"]


def test_bandwidth_queues_and_the_full_queue_drops_the_tail() -> None:
    size = 34
    line = channel(Impairments(bandwidth=size * 8 * 50, queue=10 * size))
    arrived = cross(line, 200, 100)
    log = line.take_log()
    assert {row.size for row in log} == {size}
    assert Counter(row.fate for row in log)["queue-full"] == pytest.approx(200 - 100 - 9, abs=1)
    assert max(tick - stamp for stamp, tick in arrived) == 19
    assert [stamp for stamp, _ in arrived] == sorted(stamp for stamp, _ in arrived)


def test_outages_and_events_come_and_go_at_their_times() -> None:
    event = Event(at=1.0, duration=0.5, link=Impairments(loss=1.0), direction="command")
    line = channel(Impairments(outages=((0.2, 0.1),)), 0, 1, event)
    stamps = {stamp for stamp, _ in cross(line, 200)}
    assert set(range(200)) - stamps == {*range(20, 30), *range(100, 150)}
    assert not event.concerns("measurement")


def test_where_events_overlap_the_later_in_the_list_is_in_force() -> None:
    base, first, second = (Impairments(loss=loss) for loss in (0.0, 0.1, 0.2))
    events = [Event(1.0, 2.0, first), Event(2.0, 2.0, second)]
    there = [in_force(base, events, time).loss for time in (0.5, 1.5, 2.5, 3.5, 4.5)]
    assert there == [0.0, 0.1, 0.2, 0.2, 0.0]


@pytest.mark.parametrize("tick", [0, 1, 3, 7, 29, 57])
def test_an_instant_belongs_to_the_tick_that_is_not_earlier(tick: int) -> None:
    """Sums of doubles may be a little late: 0.1 + 0.2 is still tick 3."""
    assert first_tick(sum([0.1] * tick), 0.1) == tick
    assert first_tick(0.1 * tick + 0.001, 0.1) == tick + 1


def test_a_log_replays_to_the_same_link_on_another_run(tmp_path: Path) -> None:
    link = Impairments(
        ExtraDelay("exponential", 0.02), loss=0.2, duplicate=0.2, bit_error_rate=1e-3
    )
    line = channel(link, 4)
    first = cross(line, 300)
    recorder = FileRecorder(tmp_path)
    log = line.take_log()
    recorder.link(log)
    recorder.close()
    rows = read_link_log(tmp_path / "link.csv")["command"]
    assert rows == log
    again: Channel[Command] = Channel("command", 4, TS, RecordedFates(rows))
    assert cross(again, 300) == first
    assert again.take_log() == log
    assert read_link_log(tmp_path / "link.csv")["measurement"] == []


def test_frames_that_enter_in_one_tick_are_replayed_each_as_its_own() -> None:
    def through(line: Channel[Command]) -> list[tuple[int, int]]:
        out = []
        for tick in range(60):
            for part in range(3):
                line.push(tick, command(3 * tick + part))
            out += [(message.tick, tick) for message in line.due(tick)]
        return out

    line = channel(Impairments(ExtraDelay("exponential", 0.02), loss=0.4))
    first, log = through(line), line.take_log()
    assert [row.frame for row in log] == [0, 1, 2] * 60
    again: Channel[Command] = Channel("command", 0, TS, RecordedFates(log))
    assert through(again) == first
    assert again.take_log() == log


def test_frames_that_the_log_does_not_have_are_delivered_in_time() -> None:
    again: Channel[Command] = Channel("command", 2, TS, RecordedFates([]))
    assert cross(again, 5) == [(tick, tick + 2) for tick in range(5)]
