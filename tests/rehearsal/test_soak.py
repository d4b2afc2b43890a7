"""A few turns of a soak, chosen so that they are short; and that each of its checks can fail."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

import laglab
from laglab.command import main
from laglab.soak import (
    EXPECTATIONS,
    Blow,
    Part,
    Played,
    Report,
    Sample,
    Turn,
    draw,
    failures,
    generator,
    play,
)
from laglab.soak.draw import SIGNALS
from laglab.soak.files import PAGE, faults_of
from laglab.soak.system import marked
from laglab_gateway import ROWS, TRACE_FILE

LOCKSTEP = {"pace": "lockstep", "duration": 15.0}
REAL_TIME = {"pace": "realtime", "speed": 2.0, "duration": 4.0}
CALM = Turn(1, "lab", LOCKSTEP, "udp", signed=False)
CROWDED = replace(
    CALM,
    strangers=("garbage", "foreign frames", "requests", "bad signatures", "an impostor"),
    rate=300.0,
)
TAKEN_OVER = Turn(
    2,
    "fig6",
    {**REAL_TIME, "speed": 1.0},
    "serial",
    signed=True,
    blow=Blow("controller", "SIGKILL", after=0.2, again=True),
    strangers=("garbage",),
    rate=50.0,
)
PAUSED = replace(CALM, signed=True, blow=Blow("gateway", "SIGSTOP", after=0.0))


def test_the_same_seed_draws_the_same_turns_and_all_of_them_can_be() -> None:
    turns = [draw(generator(1, number), number) for number in range(1, 60)]
    assert turns == [draw(generator(1, number), number) for number in range(1, 60)]
    assert turns != [draw(generator(2, number), number) for number in range(1, 60)]
    for turn in turns:
        turn.scenario()
    kinds = {kind for turn in turns for kind in turn.kinds}
    assert {
        "udp",
        "serial",
        "signed",
        "not signed",
        "lock-step",
        "real time",
        "plans",
        "play-out",
    } < kinds
    assert {turn.blow.signal for turn in turns if turn.blow} == set(SIGNALS)


@pytest.mark.slow
def test_strangers_change_nothing(tmp_path: Path) -> None:
    """And what is checked has been there: ticks, samples, strangers, the other trace."""
    played = play(CROWDED, tmp_path / "turn")
    assert failures(played) == {}
    assert played.trace_fault == ""
    assert played.datagrams > 20
    for part in played.parts:
        assert part.exit_code == 0
        assert part.ticks == 1500
        assert part.verdict.startswith("converged")
        assert part.samples


@pytest.mark.slow
def test_nor_does_a_pause(tmp_path: Path) -> None:
    played = play(PAUSED, tmp_path / "turn")
    assert failures(played) == {}
    assert played.trace_fault == ""
    assert [part.signal for part in played.parts] == ["SIGSTOP", None]


def test_a_side_is_killed_and_started_again(tmp_path: Path) -> None:
    played = play(TAKEN_OVER, tmp_path / "turn")
    assert failures(played) == {}
    ended = [(part.side, part.exit_code, part.signal) for part in played.parts]
    assert ended == [
        ("gateway", 0, None),
        ("controller", -9, "SIGKILL"),
        ("controller", 0, None),
    ]


WELL = (Sample(100 << 20, 9),) * 20
GATEWAY = Part("gateway", 0, "all is well", True, WELL, 120 << 20, verdict="converged", ticks=800)
CONTROLLER = replace(GATEWAY, side="controller")
AS_IT_SHOULD = Played(CALM, (GATEWAY, CONTROLLER), trace_fault="")


def with_controller(controller: Part) -> Played:
    return replace(AS_IT_SHOULD, parts=(GATEWAY, controller))


GROWING = tuple(Sample((100 + i) << 20, 9) for i in range(20))
WRONG = {
    "exit codes are those of the situation": with_controller(replace(CONTROLLER, exit_code=4)),
    "no traceback": with_controller(replace(CONTROLLER, said="Traceback (most recent call …")),
    "every side ends by itself": replace(
        AS_IT_SHOULD,
        parts=tuple(replace(part, dismissed=True, exit_code=130) for part in AS_IT_SHOULD.parts),
    ),
    "a run that nobody ends has a verdict": with_controller(replace(CONTROLLER, verdict="")),
    "files are whole and readable": with_controller(replace(CONTROLLER, faults=("torn",))),
    "in lock-step the trace is the one inline": replace(AS_IT_SHOULD, trace_fault="another"),
    "memory stays below its bound": with_controller(replace(CONTROLLER, most_memory=1 << 30)),
    "nothing grows": with_controller(replace(CONTROLLER, ticks=10_000, samples=GROWING)),
    "descriptors stay below their bound": replace(AS_IT_SHOULD, descriptors=(9, 10)),
    "no process goes on": replace(AS_IT_SHOULD, running=(1,)),
    "nothing is left behind": replace(AS_IT_SHOULD, left=("port",)),
}


def test_all_is_as_it_should_be() -> None:
    assert failures(AS_IT_SHOULD) == {}


@pytest.mark.parametrize("name", EXPECTATIONS)
def test_each_expectation_can_fail(name: str) -> None:
    assert list(failures(WRONG[name])) == [name]


def test_a_turn_alone_has_no_minutes(refused: Callable[..., str]) -> None:
    assert "leave --minutes out" in refused("soak", "--turn", "3", "--minutes", "1")


def test_sides_that_never_meet_though_nobody_was_struck_did_not_end() -> None:
    parts = tuple(
        replace(part, dismissed=True, exit_code=130, met=False) for part in AS_IT_SHOULD.parts
    )
    apart = replace(AS_IT_SHOULD, parts=parts)
    assert list(failures(apart)) == ["every side ends by itself"]


def test_what_is_in_a_folder_is_no_soaks_to_take_away(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "turn-1").mkdir()
    (tmp_path / "turn-1" / "notes").write_text("precious")
    with pytest.raises(SystemExit) as ended:
        main(["soak", "--minutes", "0.01", "--out", str(tmp_path)])
    assert ended.value.code == 2
    assert "turn-1 is there already" in capsys.readouterr().err
    assert (tmp_path / "turn-1" / "notes").read_text() == "precious"


def test_files_that_are_torn_or_out_of_order_are_told(tmp_path: Path) -> None:
    laglab.run("lab-radio", {"duration": 1.0}, out=tmp_path / "run")
    assert list(faults_of(tmp_path / "run", killed=False)) == []
    trace = (tmp_path / "run" / TRACE_FILE).read_text()
    *rows, last = trace.splitlines(keepends=True)
    again = "0" + last.removeprefix("100")  # a robot that has begun again
    (tmp_path / "run" / TRACE_FILE).write_text("".join([*rows, again]))
    assert list(faults_of(tmp_path / "run", killed=False)) == []
    (tmp_path / "run" / TRACE_FILE).write_text("".join([*rows, rows[-1], last]))
    told = list(faults_of(tmp_path / "run", killed=False))
    assert told == ["the times of its trace are not in order"]
    for name in ("link.csv", "arrivals.csv", "claims.csv"):
        whole = (tmp_path / "run" / name).read_bytes()
        for cut in (b"", whole[:-3]):
            (tmp_path / "run" / name).write_bytes(cut)
            assert f"{name}: its last line is torn" in faults_of(tmp_path / "run", killed=True)
        (tmp_path / "run" / name).write_bytes(whole)
    (tmp_path / "run" / TRACE_FILE).write_text(trace[:PAGE])
    assert list(faults_of(tmp_path / "run", killed=True)) == []
    assert f"{TRACE_FILE}: its last line is torn" in faults_of(tmp_path / "run", killed=False)


def test_a_descriptor_that_is_not_a_files_is_told() -> None:
    opened = (*WELL[:10], *(Sample(100 << 20, 9 + len(ROWS) + 1),) * 10)
    assert list(failures(with_controller(replace(CONTROLLER, samples=opened)))) == ["nothing grows"]
    opened = (*WELL[:10], *(Sample(100 << 20, 9 + len(ROWS)),) * 10)
    assert failures(with_controller(replace(CONTROLLER, samples=opened))) == {}


LEAKING = """
import subprocess, sys, tempfile
if sys.orig_argv[-1].endswith("controller") and "--endpoint" in sys.orig_argv:
    tempfile.mkstemp()
    print("Traceback (most recent call last):")
    subprocess.Popen(["sleep", "30"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
"""
"""For Python to do at its start, before our own code."""


def test_what_leaks_is_told_and_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A controller that leaves a file, a traceback and a child."""
    (tmp_path / "sitecustomize.py").write_text(LEAKING)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    out = tmp_path / "soak"
    with pytest.raises(SystemExit) as ended:
        main(["soak", "--seed", "1", "--turn", "1", "--out", str(out)])
    assert ended.value.code == 1
    said = capsys.readouterr().out
    assert "turn 1: nothing is left behind: the controller left controller.tmp/" in said
    assert "turn 1: no traceback: the controller said 'Traceback'" in said
    assert "turn 1: no process goes on: 1 processes go on running" in said
    assert "again: laglab soak --seed 1 --turn 1" in said
    out /= "again-1"
    assert json.loads((out / "turn-1" / "turn.json").read_text())["failures"]
    report = msgspec.json.decode((out / "soak.json").read_text(), type=Report)
    assert [failed.turn for failed in report.tally.failed] == [1]
    assert "1 of them failed" in (out / "soak.md").read_text()
    assert not marked(str(tmp_path)), "what goes on is ended"
