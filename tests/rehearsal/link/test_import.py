"""What others measured, as link.csv; each file in the form in which its program writes it."""

import gzip
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from laglab.link.errors import LinkFileError
from laglab.link.importing import read_table, recognise
from laglab.link.importing.tables import LARGEST
from laglab.link.measured import read_measured
from laglab.scenario import load
from laglab_gateway import LinkRow

from .measured import HOW, imported
from .printed import LINUX, pings

Ended = Callable[..., Any]
Refused = Callable[..., str]


def test_resampling_gives_a_frame_a_tick(tmp_path: Path) -> None:
    measured = imported(tmp_path, LINUX, HOW._replace(interval=0.05))
    delay = measured.command.delay
    assert len(delay) == 20
    np.testing.assert_allclose(delay[:5], [0.005, 0.0055, 0.006, 0.0065, 0.007])
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(delay)), [7, 8, 9, 10, *range(15, 20)])
    assert "Measured every 0.2 s, a tick is 0.05 s" in measured.notes[-1]


def trip(number: int, lost: str, ahead_ns: int, delays: tuple[int, int]) -> dict[str, Any]:
    """As irtt writes it, by clocks of which the server's is ahead."""
    up, down = delays
    there = {"delay": {"send": up + ahead_ns, "receive": down - ahead_ns, "rtt": up + down}}
    times = {"send": {"wall": 17 * 10**17, "monotonic": number * 20_000_000}}
    return {
        "seqno": number,
        "lost": lost,
        "timestamps": {"client": times},
        **(there if lost == "false" else {"delay": {}}),
    }


@pytest.mark.parametrize("packed", [False, True])
def test_irtt_is_one_way_by_two_clocks(tmp_path: Path, packed: bool) -> None:
    fates = ["false", "true_up", "false", "true_down", "true", "false"]
    ms = 1_000_000
    delays = [(5 * ms, 7 * ms), (0, 0), (9 * ms, 5 * ms), (0, 0), (0, 0), (6 * ms, 8 * ms)]
    # The fastest took 5 ms each way: half of the shortest round trip is what it is.
    trips = [trip(k, fates[k], 10**10, delays[k]) for k in range(6)]
    text = json.dumps({"version": {}, "round_trips": trips}).encode()
    measured = imported(tmp_path, gzip.compress(text) if packed else text)
    assert measured.interval == pytest.approx(0.02)
    np.testing.assert_allclose(
        measured.command.delay, [0.005, np.nan, 0.009, 0.009, np.nan, 0.006], atol=1e-9
    )
    np.testing.assert_allclose(
        measured.measurement.delay, [0.007, 0.007, 0.005, np.nan, 0.005, 0.008], atol=1e-9
    )
    assert "half of the shortest round trip, 10 ms" in measured.notes[0]
    assert "which way it was lost is not known" in measured.notes[1]


def test_irtt_without_the_servers_times_is_halved(tmp_path: Path) -> None:
    trips = [trip(k, "false", 0, (4_000_000, 6_000_000)) for k in range(3)]
    for each in trips:
        del each["delay"]["send"], each["delay"]["receive"]
    measured = imported(tmp_path, json.dumps({"round_trips": trips}))
    for _, flow in measured.flows:
        np.testing.assert_allclose(flow.delay, 0.005)


NETEM = """\
# This is the distribution table for one of two values.
 -8192 -8192 -8192 -8192
  8192  8192  8192  8192
"""


def test_a_table_of_netems_is_a_distribution(ended_here: Ended, tmp_path: Path) -> None:
    (tmp_path / "two.dist").write_text(NETEM)
    result = ended_here("link", "import", "two.dist", "--mean", "0.05", "--spread", "0.01")
    assert result.code == 0, result.err
    delay = load(str(tmp_path / "link.toml")).link.command.extra_delay
    assert delay is not None
    rng = np.random.default_rng(1)
    drawn = np.array([delay.draw(rng) for _ in range(4000)])
    assert np.mean(np.isclose(drawn, 0.04)) == pytest.approx(0.5, abs=0.1)
    assert np.mean(np.isclose(drawn, 0.06)) == pytest.approx(0.5, abs=0.1)
    assert read_table(tmp_path / "link.toml", 0.0, 0.0) is None
    (tmp_path / "large.dist").write_text("-1 0 1 \n" * (LARGEST // 8 + 1))
    assert read_table(tmp_path / "large.dist", 0.0, 1.0) is None


def test_what_was_imported_is_read_again(ended_here: Ended, tmp_path: Path) -> None:
    (tmp_path / "ping.txt").write_text(LINUX)
    result = ended_here("link", "import", "ping.txt", "--interval", "0.01")
    assert result.code == 0, result.err
    assert "half of a round trip" in " ".join(result.out.split())
    again = read_measured(tmp_path / "link.csv", 0.01)
    assert len(again.command.delay) == 100
    assert ended_here("link", "import", "link.csv").code == 2


def test_of_several_copies_the_first_that_came_counts(tmp_path: Path) -> None:
    copies = ("0,0,delivered,0.05", "0,1,delivered,0.01", "1,0,lost,0.0", "1,1,delivered,0.03")
    told = [each.split(",") for each in copies]
    lines = [f"command,{tick},0,{copy},35,{fate},{extra}" for tick, copy, fate, extra in told]
    (tmp_path / "link.csv").write_text("\n".join((",".join(LinkRow._fields), *lines)) + "\n")
    measured = read_measured(tmp_path / "link.csv", 0.01)
    np.testing.assert_allclose(measured.command.delay, [0.01, 0.03])


NOT_FOR = {
    "ping.txt": ("--back", "--clocks-within", "--mean", "--spread"),
    "trace": ("--clocks-within", "--mean", "--spread"),
    "two.dist": ("--back", "--clocks-within", "--interval"),
}


@pytest.mark.parametrize("name", NOT_FOR)
def test_an_option_for_another_kind_of_file_is_refused(
    name: str, tmp_path: Path, refused: Refused
) -> None:
    files = {"ping.txt": pings(3), "trace": "1\n5\n9\n", "two.dist": NETEM}
    (tmp_path / name).write_text(files[name])
    table = ("--mean", "0.1", "--spread", "0.1") if name == "two.dist" else ()
    for option in NOT_FOR[name]:
        command = ("link", "import", tmp_path / name, *table, option, "0.01")
        assert f"{option} is not" in refused(*command)


def irtt_of(rtt: int, apart: int = 10_000_000) -> bytes:
    trips = [trip(k, "false", 0, (0, rtt)) for k in range(3)]
    for number, each in enumerate(trips):
        each["timestamps"]["client"]["send"]["monotonic"] = number * apart
    return json.dumps({"round_trips": trips}).encode()


BAD = {
    "nothing": (None, "nothing cannot be read"),
    "empty": (b"", "none of what is known here"),
    "prose": (b"it rained\n", "none of what is known here"),
    "numbers": (b"5\n3\n", "none of what is known here"),
    "other.json": (b'{"a": 1}', "not as irtt writes it"),
    "cut.json": (b'{"round_trips": [', "not as irtt writes it"),
    "none.json": (b'{"round_trips": []}', "irtt"),
    "cut.gz": (gzip.compress(b"{}" * 99)[:-12], "cannot be read"),
    "cut.pcap": (bytes.fromhex("d4c3b2a1") + b"\0" * 9, "not a readable capture"),
    "empty.pcap": (bytes.fromhex("d4c3b2a102000400") + b"\0" * 8 + b"\0\0\4\0\1\0\0\0", "no run"),
    "other.tlog": (b"\0" * 8 + b"\xfd" + b"\0" * 99, "no frame of the dialect"),
    "two.dist": (NETEM.encode(), "say --mean and --spread"),
    "wide.dist": (b"-1\n" + b"9" * 30, "none of what is known here"),
    "huge.trace": (b"1\n" + b"9" * 400, "give a shorter trace"),
    "deep.json": (b'{"a": ' + b"[" * 50_000, "not as irtt writes it"),
    "huge.json": (irtt_of(rtt=10**400), "not as irtt writes it"),
    "late.json": (irtt_of(rtt=10**30), "not from 0 to 10000 s"),
    "no-time.json": (irtt_of(rtt=1, apart=0), "no times that go on"),
    "many.txt": (f"{pings(1)}99999999999 packets transmitted\n".encode(), "10000000 at most"),
    "late.txt": (b"64 bytes: icmp_seq=1 time=999999999 ms\n", "not from 0 to 10000 s"),
    "lost.txt": (b"PING x\n\n10 packets transmitted, 0 received\n", "no answer at all"),
    "timeouts.txt": (b"Request timeout for icmp_seq 0\n" * 3, "no answer at all"),
    "windows.txt": (b"Request timed out.\n" * 3, "no answer at all"),
    "broken.gz": (gzip.compress(b"{}" * 99)[:15] + b"\xff" * 30, "cannot be read"),
}


@pytest.mark.parametrize("name", BAD)
def test_what_tells_nothing_is_one_line(name: str, tmp_path: Path, refused: Refused) -> None:
    data, said = BAD[name]
    if data is not None:
        (tmp_path / name).write_bytes(data)
    assert said in refused("link", "import", tmp_path / name, "--out", tmp_path / "link.csv")
    assert not (tmp_path / "link.csv").exists()


def test_what_unpacks_to_too_much_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recognise, "MOST_BYTES", 2**20)
    with pytest.raises(LinkFileError, match="more than 1 MB"):
        imported(tmp_path, gzip.compress(b" " * (2**20 + 1)))


def test_ticks_without_number_are_refused(tmp_path: Path) -> None:
    with pytest.raises(LinkFileError, match="give a longer --interval"):
        imported(tmp_path, irtt_of(rtt=1, apart=10**13), HOW._replace(interval=0.001))


def test_a_measurement_is_not_lost_to_what_is_made_of_it(tmp_path: Path, refused: Refused) -> None:
    """It may have taken a day."""
    log, ping = tmp_path / "link.csv", tmp_path / "ping.txt"
    for path in (log, ping):
        path.write_text(pings(1, 2, 3))
    (tmp_path / "link.toml").symlink_to(log)
    for told in (("fit", log, "--out", tmp_path / "link.toml"), ("import", ping, "--out", ping)):
        assert f"--out {told[-1]}: that is the file to be read" in refused("link", *told)
    assert log.read_text() == ping.read_text() == pings(1, 2, 3)
