"""One direction of the link: exact when ideal; seeded, recorded and repeatable when not."""

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_gateway import (
    Burst,
    Channel,
    ConfigError,
    Event,
    ExtraDelay,
    FileRecorder,
    Impairments,
    LinkRow,
    RandomFates,
    RecordedFates,
    TimelineError,
    first_tick,
    read_link_log,
)
from laglab_gateway.link.fates import Fate, FateKind
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
        out += [(crossing.message.tick, tick) for crossing in line.due(tick)]
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
    rows = read_link_log(tmp_path / "link.csv", "command")
    assert rows == log
    again: Channel[Command] = Channel("command", 4, TS, RecordedFates(rows))
    assert cross(again, 300) == first
    assert again.take_log() == log
    assert read_link_log(tmp_path / "link.csv", "measurement") == []


def test_frames_that_enter_in_one_tick_are_replayed_each_as_its_own() -> None:
    def through(line: Channel[Command]) -> list[tuple[int, int]]:
        out = []
        for tick in range(60):
            for part in range(3):
                line.push(tick, command(3 * tick + part))
            out += [(crossing.message.tick, tick) for crossing in line.due(tick)]
        return out

    line = channel(Impairments(ExtraDelay("exponential", 0.02), loss=0.4))
    first, log = through(line), line.take_log()
    assert [row.frame for row in log] == [0, 1, 2] * 60
    again: Channel[Command] = Channel("command", 0, TS, RecordedFates(log))
    assert through(again) == first
    assert again.take_log() == log


@pytest.mark.parametrize("tick", [0, 1, 3, 7, 29, 57])
def test_an_instant_belongs_to_the_tick_that_is_not_earlier(tick: int) -> None:
    """Sums of doubles may be a little late: 0.1 + 0.2 is still tick 3."""
    assert first_tick(sum([0.1] * tick), 0.1) == tick
    assert first_tick(0.1 * tick + 0.001, 0.1) == tick + 1


def test_frames_that_the_log_does_not_have_are_delivered_in_time() -> None:
    again: Channel[Command] = Channel("command", 2, TS, RecordedFates([]))
    assert cross(again, 5) == [(tick, tick + 2) for tick in range(5)]


@pytest.mark.parametrize("text", ["", "a,b\n", "direction\ncommand\n", "\0"])
def test_what_is_no_link_log_is_refused_by_name(tmp_path: Path, text: str) -> None:
    path = tmp_path / "other.csv"
    path.write_text(text)
    with pytest.raises(TimelineError, match=r"other\.csv"):
        read_link_log(path, "command")


UNBELIEVABLE = {
    "0,0,0,35,delivered,nan": "extra must be from 0",
    "0,0,0,35,delivered,inf": "extra must be from 0",
    "0,0,0,35,delivered,-0.01": "extra must be from 0",
    "0,0,0,35,delivered,1e300": "extra must be from 0",
    "-1,0,0,35,delivered,0": "a tick must be 0 or more",
    "10000000000000,0,0,35,delivered,0": "below 10000000",
    "0,0,0,-35,delivered,0": "size must be 0 or more",
    "0,1,0,35,delivered,0": "frames of a tick are counted from 0",
    "0,0,1,35,delivered,0": "copies of a frame are counted from 0",
}


@pytest.mark.parametrize("row", UNBELIEVABLE)
def test_what_no_run_records_is_refused(tmp_path: Path, row: str) -> None:
    path = tmp_path / "link.csv"
    path.write_text(",".join(LinkRow._fields) + f"\ncommand,{row}\n")
    with pytest.raises(TimelineError, match=UNBELIEVABLE[row]):
        read_link_log(path, "command")


def test_a_replay_begins_again_at_its_end_in_both_directions_at_once() -> None:
    rows = [LinkRow("command", tick, 0, 0, 35, *told) for tick, told in enumerate(TOLD)]
    fates = RecordedFates(rows, range(5))
    got = [fates.of(tick, tick * TS, b"x")[0] for tick in range(15)]
    assert [each.kind for each in got[:3]] == ["delivered", "lost", "delivered"]
    assert [each.kind for each in got[3:5]] == ["delivered"] * 2, "no record of these ticks"
    assert got[5:10] == got[:5] == got[10:]
    assert [each.extra for each in got[:5]] == [0.01, 0.0, 0.03, 0.0, 0.0]


TOLD = (("delivered", 0.01), ("lost", 0.0), ("delivered", 0.03))


def test_what_is_in_a_recorded_frames_datagram_shares_its_fate() -> None:
    fates = RecordedFates([LinkRow("command", 7, 0, 0, 35, "lost", 0.0)])
    for tick in (7, 8, 107):
        assert [fates.of(tick, 0.0, b"x")[0].kind for _ in range(3)] == ["lost"] * 3
    assert RecordedFates([]).of(3, 0.0, b"x") == [Fate(FateKind.DELIVERED, 0.0, b"x")]


@pytest.mark.parametrize("correlation", [0.0, 0.9])
def test_a_table_of_delays_is_drawn_as_it_is_and_as_it_wanders(correlation: float) -> None:
    quantiles = (0.01, 0.02, 0.05, 0.1)
    table = ExtraDelay("table", 0.005, quantiles=quantiles, correlation=correlation)
    fates = RandomFates(Impairments(extra_delay=table), [], np.random.default_rng(3))
    drawn = np.array([fates.of(k, k * TS, b"x")[0].extra for k in range(20_000)])
    at = np.quantile(drawn, [0.0, 1 / 3, 2 / 3, 1.0])
    np.testing.assert_allclose(at, np.array(quantiles) + 0.005, rtol=0.08)
    ranks = np.argsort(np.argsort(drawn))
    assert np.corrcoef(ranks[1:], ranks[:-1])[0, 1] == pytest.approx(correlation, abs=0.03)


@pytest.mark.parametrize("distribution", ["constant", "uniform", "normal", "exponential"])
def test_delays_that_wander_scatter_as_those_that_do_not(distribution: Any) -> None:
    spread = [
        RandomFates(
            Impairments(extra_delay=ExtraDelay(distribution, 0.04, 0.01, correlation=kept)),
            [],
            np.random.default_rng(5),
        )
        for kept in (0.0, 0.5)
    ]
    drawn = [[each.of(k, 0.0, b"x")[0].extra for k in range(10_000)] for each in spread]
    shares = [0.05, 0.5, 0.95]
    np.testing.assert_allclose(*(np.quantile(each, shares) for each in drawn), rtol=0.1)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"distribution": "table"}, "quantiles: a table has two delays or more"),
        ({"quantiles": (0.2, 0.1)}, "quantiles: must rise from one to the next"),
        ({"correlation": 1.0}, "correlation: must be below 1"),
    ],
)
def test_delays_that_cannot_be_are_refused(values: dict[str, Any], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        ExtraDelay(**values)
