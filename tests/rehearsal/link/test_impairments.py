"""A link that loses, delays and repeats: seeded, recorded, repeatable, and survived."""

import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from laglab_gateway import read_link_log, read_trace
from laglab_gateway.link.log import LINK_HEADER
from laglab_protocol import Statustext, read_tlog

Laglab = Callable[..., subprocess.CompletedProcess[str]]
Rehearsed = Callable[..., dict[str, Any]]
Ended = Callable[..., Any]
Refused = Callable[..., str]


@pytest.mark.slow
def test_the_same_seed_gives_the_same_link_on_every_transport(
    laglab: Laglab, tmp_path: Path
) -> None:
    for transport in ("inline", "udp", "serial"):
        options = ("--duration", "4", "--transport", transport, "--out", transport)
        assert laglab("run", "lab-radio", *options).returncode == 0
    for name in ("trace.csv", "link.csv"):
        contents = [(tmp_path / way / name).read_bytes() for way in ("inline", "udp", "serial")]
        assert contents[0] == contents[1] == contents[2]


def test_the_bad_radio_is_survived_and_accounted_for(rehearsed: Rehearsed) -> None:
    summary = rehearsed("lab-radio")
    assert summary["converged"]
    for direction, configured in (("command", 10), ("measurement", 20)):
        audit = summary["link"][direction]
        assert audit["configured"] == configured
        assert audit["measured"]["min"] >= configured
        assert audit["measured"]["jitter"] > 0
        assert audit["reordered"] > 0
    assert summary["link"]["command"]["lost"]["lost"] > 50
    assert summary["link"]["measurement"]["lost"]["burst"] > 50
    assert summary["link"]["refused"]["stale"] == summary["link"]["command"]["reordered"]


def test_an_ideal_link_measures_what_was_configured(rehearsed: Rehearsed) -> None:
    link = rehearsed("fig8", "-n", "7", "-m", "3", "--duration", "1")["link"]
    for direction, delay, arrived in (("command", 7, 94), ("measurement", 3, 98)):
        assert link[direction]["measured"] == {
            "min": delay, "mean": delay, "max": delay, "jitter": 0.0,
        }  # fmt: skip
        assert link[direction]["arrived"] == arrived


def test_a_recorded_link_happens_again_on_another_run(rehearsed: Rehearsed, tmp_path: Path) -> None:
    rehearsed("lab-radio", "--duration", "4")
    (tmp_path / "run").rename(tmp_path / "first")
    log = tmp_path / "first" / "link.csv"
    rehearsed("lab", "--duration", "4", "--timeline", str(log))
    assert (tmp_path / "run" / "link.csv").read_bytes() == log.read_bytes()
    traces = [(tmp_path / name / "trace.csv").read_bytes() for name in ("first", "run")]
    assert traces[0] == traces[1]


OUTAGE = """
[[event]]
at = 2.0
duration = 1.5
direction = "command"
link = { loss = 1.0 }
"""


def test_when_commands_stop_coming_the_robot_ramps_to_a_stop_and_says_so(
    rehearsed: Rehearsed, tmp_path: Path
) -> None:
    timeline = tmp_path / "outage.toml"
    timeline.write_text(OUTAGE)
    summary = rehearsed("lab", "--timeline", str(timeline))
    trace = read_trace(tmp_path / "run" / "trace.csv")
    last = 209  # the last command that got through was sent at 1.99 s and came into force here
    assert summary["link"]["failsafe_stops"] == [last + 50]
    np.testing.assert_array_equal(trace["v"][last : last + 51], trace["v"][last])
    ramp = np.abs(trace["v"][last + 50 : last + 101])
    assert (np.diff(ramp) < 0).all()
    assert (trace["v"][last + 100 : 359] == 0).all()
    assert trace["v"][360] != 0
    said = [
        frame.message.text
        for _, frame in read_tlog(tmp_path / "run" / "robot.tlog")
        if isinstance(frame.message, Statustext)
    ]
    assert said == [b"no fresh command for 0.5 s: stopping"]
    assert summary["converged"]


def test_commands_out_of_the_robots_limits_are_refused_and_counted(
    rehearsed: Rehearsed, tmp_path: Path
) -> None:
    own = tmp_path / "narrow.toml"
    own.write_text("[safety]\nv_limit = 5.0\n")
    summary = rehearsed(str(own))
    trace = read_trace(tmp_path / "run" / "trace.csv")
    fast = np.abs(trace["v_sent"]) > 5.0
    assert summary["link"]["refused"] == {"out of limits": int(fast[:-10].sum())}
    assert np.abs(trace["v"]).max() <= 5.0


def test_a_longer_run_goes_through_a_replay_again_and_says_so(
    ended: Ended, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    recorded = [
        f"{way},{tick},0,0,60,{'lost' if tick % 3 else 'delivered'},0.0\n"
        for tick in range(50)
        for way in ("command", "measurement")
    ]
    (tmp_path / "link.csv").write_text(LINK_HEADER + "".join(recorded))
    options = ("--timeline", "link.csv", "--duration", "2", "--transport", "inline")
    told = ended("run", "lab", *options).err
    assert "link.csv holds 0.5 s of a link: the run goes through it 4.02 times" in told
    rows = read_link_log(tmp_path / "runs/lab/link.csv")["command"]
    fates = [row.fate for row in rows if row.frame == 0]
    assert fates == [("delivered", "lost", "lost")[tick % 50 % 3] for tick in range(201)]
    short = (*options[:3], "0.3", "--transport", "inline", "--force")
    assert "holds" not in ended("run", "lab", *short).err


BAD_TIMELINES = {
    "nothing.toml": (None, "nothing.toml: No such file"),
    "syntax.toml": ("at = ", "syntax.toml: neither TOML (Invalid value"),
    "picture.png": ("\0\1", "picture.png: neither TOML (Invalid statement"),
    "notes.txt": ("it rained", "notes.txt: neither TOML (Expected '='"),
    "other.toml": ("loss = 1.0", "list of [[event]]"),
    "field.toml": ("[[event]]\nat = -1.0\nduration = 1\nlink = {}", "link.event.0.at"),
    "unknown.toml": (
        "[[event]]\nat = 1\nduration = 1\nlink = {fog = 1}",
        "link.event.0.link.fog: unknown key",
    ),
    "nothing.csv": (None, "nothing.csv"),
    "other.csv": ("a,b\n1,2\n", "not a link log: expected the columns"),
    "long.csv": ('"' + "x" * 200_000 + "\n", "not a readable link log"),
}


@pytest.mark.parametrize("name", BAD_TIMELINES)
def test_a_bad_timeline_is_one_line_that_names_it(
    name: str, tmp_path: Path, refused: Refused
) -> None:
    text, named = BAD_TIMELINES[name]
    if text is not None:
        (tmp_path / name).write_text(text)
    assert named in refused("run", "fig6", "--timeline", tmp_path / name)


def test_what_was_really_run_holds_the_timeline(
    ended: Ended, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "outage.toml").write_text(OUTAGE)
    options = ("--timeline", "outage.toml", "--duration", "3", "--transport", "inline")
    assert ended("run", "lab", *options, "--out", "first").code == 0
    again = ("--transport", "inline", "--out", "again")
    assert ended("run", "first/scenario.toml", *again).code == 0
    traces = [(tmp_path / name / "trace.csv").read_bytes() for name in ("first", "again")]
    assert traces[0] == traces[1]
    assert json.loads((tmp_path / "first" / "summary.json").read_text())["scenario"] == "lab"


def test_a_run_moves_with_what_it_refers_to(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ended: Ended
) -> None:
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str) -> None:
        assert ended("run", *arguments, "--duration", "1", "--transport", "inline").code == 0

    run("lab-radio", "--out", "runs/radio")
    run("lab", "--timeline", "runs/radio/link.csv", "--out", "runs/again")
    Path("runs").rename("moved")
    run("moved/again/scenario.toml", "--out", "third")
    places = ("moved/radio", "moved/again", "third")
    assert len({Path(place, "link.csv").read_bytes() for place in places}) == 1
    assert 'replay = "../moved/radio/link.csv"' in Path("third", "scenario.toml").read_text()


def test_a_timeline_told_by_hand_beats_a_replay_of_the_file(
    rehearsed: Rehearsed, tmp_path: Path
) -> None:
    (tmp_path / "link.csv").write_text(LINK_HEADER + "command,0,0,0,35,delivered,0.01\n")
    (tmp_path / "outage.toml").write_text("[[event]]\nlink = { loss = 1.0 }\n")
    own = tmp_path / "own.toml"
    own.write_text("link.replay = 'link.csv'\nduration = 0.5\n")
    timeline = ("--timeline", str(tmp_path / "outage.toml"))
    assert rehearsed(str(own))["link"]["measurement"]["arrived"] == 31
    assert rehearsed(str(own), *timeline)["link"]["measurement"]["arrived"] == 0
