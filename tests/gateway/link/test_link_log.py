"""What a link log must hold, and the fates that it records."""

from pathlib import Path

import pytest

from laglab_gateway import LinkRow, RecordedFates, TimelineError, read_link_log
from laglab_gateway.link.fates import Fate, FateKind

TS = 0.01


@pytest.mark.parametrize("text", ["", "a,b\n", "direction\ncommand\n", "\0"])
def test_what_is_no_link_log_is_refused_by_name(tmp_path: Path, text: str) -> None:
    path = tmp_path / "other.csv"
    path.write_text(text)
    with pytest.raises(TimelineError, match=r"other\.csv"):
        read_link_log(path)


HEADER = ",".join(LinkRow._fields)
ROW = "command,0,0,0,35,delivered,0.0"


@pytest.mark.parametrize("text", [f"{HEADER}\n{ROW}\n\n", f"\ufeff{HEADER}\r\n{ROW}\r\n,,,,,,\r\n"])
def test_a_link_log_is_read_as_editors_and_spreadsheets_write_it(tmp_path: Path, text: str) -> None:
    path = tmp_path / "link.csv"
    path.write_text(text, "utf-8", newline="")
    assert read_link_log(path)["command"] == [LinkRow("command", 0, 0, 0, 35, "delivered", 0.0)]


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("command,0", "line 3: must have 7 columns"),
        (f"{ROW},1", "line 3: must have 7 columns"),
        (ROW.replace("35", "many"), "line 3: invalid literal for int.*'many'"),
        (ROW.replace("delivered", "eaten"), "line 3: 'eaten' is not a valid FateKind"),
    ],
)
def test_the_line_that_cannot_be_read_is_named(tmp_path: Path, row: str, said: str) -> None:
    path = tmp_path / "link.csv"
    path.write_text(f"{HEADER}\n{ROW}\n{row}\n")
    with pytest.raises(TimelineError, match=rf"link\.csv is not a readable link log: {said}"):
        read_link_log(path)


def test_a_link_log_that_is_not_there_is_told_in_words(tmp_path: Path) -> None:
    with pytest.raises(TimelineError, match=r"log: No such file or directory$"):
        read_link_log(tmp_path / "none.csv")


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
        read_link_log(path)


def test_a_frame_goes_one_of_two_ways(tmp_path: Path) -> None:
    path = tmp_path / "link.csv"
    path.write_text(",".join(LinkRow._fields) + "\nupwards,0,0,0,35,delivered,0\n")
    with pytest.raises(TimelineError, match=r"upwards.* a direction is command or measurement"):
        read_link_log(path)


TOLD = (("delivered", 0.01), ("lost", 0.0), ("delivered", 0.03))


def test_a_replay_begins_again_at_its_end_in_both_directions_at_once() -> None:
    rows = [LinkRow("command", tick, 0, 0, 35, *told) for tick, told in enumerate(TOLD)]
    fates = RecordedFates(rows, range(5))
    got = [fates.of(tick, tick * TS, b"x")[0] for tick in range(15)]
    assert [each.kind for each in got[:3]] == ["delivered", "lost", "delivered"]
    assert [each.kind for each in got[3:5]] == ["delivered"] * 2, "no record of these ticks"
    assert got[5:10] == got[:5] == got[10:]
    assert [each.extra for each in got[:5]] == [0.01, 0.0, 0.03, 0.0, 0.0]


def test_a_record_that_begins_later_is_replayed_at_its_own_ticks() -> None:
    rows = [LinkRow("command", tick, 0, 0, 35, *told) for tick, told in enumerate(TOLD, start=5)]
    fates = RecordedFates(rows)
    got = [fates.of(tick, tick * TS, b"x")[0] for tick in range(5, 11)]
    assert [(each.kind, each.extra) for each in got] == [*TOLD, *TOLD]


def test_what_is_in_a_recorded_frames_datagram_shares_its_fate() -> None:
    fates = RecordedFates([LinkRow("command", 7, 0, 0, 35, "lost", 0.0)])
    for tick in (7, 8, 107):
        assert [fates.of(tick, 0.0, b"x")[0].kind for _ in range(3)] == ["lost"] * 3
    assert RecordedFates([]).of(3, 0.0, b"x") == [Fate(FateKind.DELIVERED, 0.0, b"x")]
