"""A study that cannot be: one line, exit 2, before anything runs; 4 for what breaks on the way."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from .studying import SHORT, SMALL
from .test_full_disk import MOUNTED, may_mount

Refused = Callable[..., str]
Start = Callable[..., "subprocess.Popen[str]"]

BASE = 'scenario = "lab"\nseeds = 2\n'
WRONG = {
    '[grid]\n"link.command_delay" = []': "grid: link.command_delay: must have a value at least",
    '[grid]\n"link.command_delay" = [1, -2]': "with link.command_delay = -2: link.command_delay: "
    "must be 0 or more, not -2",
    '[grid]\n"link.comand_delay" = [1]': "unknown key; did you mean link.command_delay?",
    "[grid]\nlink.command_delay = 3": "grid: link.command_delay: must be a list of values, not 3",
    "[grid]\nnoise = [true, 3]": "grid: noise: must have values of one kind",
    "[grid]\nnoise = [true, true]": "grid: noise: must have each value once",
    '[grid]\n"link.command" = [{ loss = 0.1 }]\n"link.command.loss" = [0.2]': "command.loss: "
    "link.command, too, says what it is: leave one out",
    '[grid]\n"link.command.loss" = [0.2]\n"link.command" = [{ loss = 0.1 }]': "command.loss: "
    "link.command, too, says what it is: leave one out",
    '[grid]\n"plant.parameters" = [{ "a.b" = 1 }]\n"plant.parameters.a.b" = [2]': "parameters.a.b: "
    "plant.parameters, too, says what it is: leave one out",
    '[grid]\n"plant.event" = [[{ at = 1.0 }]]\n"plant.event.0.at" = [2.0]': "plant.event.0.at: "
    "plant.event, too, says what it is: leave one out",
    "[grid]\nseed = [1]": "the seeds of a study are said by `seeds`",
    '[grid]\n"estimator.kind" = ["popf", "nonsense"]': "must be one of raw, ekf",
    "[grid]\nduration = [inf]": "duration: must be finite here",
    '[grid]\npace = ["realtime"]': "pace: must be lockstep in a study",
    '[grid]\n"link.replay" = ["nowhere.csv"]': "nowhere.csv is not a readable link log",
    "[start]\nradius = 3.0\n[grid]\nstart = [[1.0, 2.0, 0.0]]": "grid: start: [start] gives every",
    "[start]\nradius = -3.0": "start.radius: must be above 0",
    "[start]\nradius = 2000.0": "start.radius: must be 1000 or less",
    "[start]\nradius = 1.0\nx = 2.0": "start.x: unknown key; known here: radius",
    "sedes = 3": "sedes: unknown key; known here: scenario, description, seeds, grid, start",
    'also = ["alarms"]': "also: 'alarms' is none of alarm_s, alarm_error",
    "also = [3]": "also",
    "[[": "not a readable TOML file",
}
ALONE = {
    "seeds = 3": "scenario: must be there",
    'scenario = "nowhere"': "nowhere: no such scenario",
    "[scenario]\nnonsense = 3": "nonsense: unknown key",
    'scenario = "lab"\nseeds = 0': "seeds: must be a number of seeds, 1 or more",
    'scenario = "lab"\nseeds = [1, 1]': "seeds: must have each seed once",
}


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(
    ("text", "said"), [*((BASE + text, said) for text, said in WRONG.items()), *ALONE.items()]
)
def test_what_is_wrong_in_its_file_is_one_line(text: str, said: str, refused: Refused) -> None:
    Path("bad.toml").write_text(text)
    assert said in refused("sweep", "bad.toml")
    assert not Path("studies").exists()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nonsense"], "nonsense: no such study; shipped: claims"),
        (["gains", "--set", "law.gama=1"], "unknown key; did you mean law.gamma?"),
        (
            ["gains", "--seeds", "10000000"],
            "3150000000 runs (315 points of the grid, 10000000 seed",
        ),
        (["gains", "--limit", "3149"], "say --limit 3150"),
        (["gains", "--set", "law.gamma=1"], "law.gamma: the study gives its runs their own"),
        (["gains", "--set", "seed=7"], "seed: the study gives its runs their own"),
        (["claims", "--set", "start=[1.0, 2.0, 0.0]"], "start: the study gives its runs their own"),
        (["gains", "--scheduler", "tcp://127.0.0.1:1"], "no dask scheduler answers there"),
        (["gains", "--scheduler", ""], "--scheduler : must be `local` or tcp://HOST:PORT"),
        (["gains", "--scheduler", "tcp://127.0.0.1:9", "--workers", "2"], "says how many it has"),
        (["gains", "--out", "/dev/null"], "--out /dev/null: that is a file"),
        (["gains", "--out", "/proc/nowhere"], "--out /proc/nowhere: cannot write there"),
    ],
)
def test_what_is_asked_for_in_vain_is_one_line(
    arguments: list[str], said: str, refused: Refused
) -> None:
    assert said in refused("sweep", *arguments)
    assert not Path("studies").exists()


def test_without_the_extra_it_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, refused: Refused
) -> None:
    monkeypatch.setattr("laglab.extras.find_spec", lambda module: module != "pyarrow" or None)
    assert "pip install 'laglab[study]' brings it" in refused("sweep", "gains")


def test_a_disk_that_fills_up_is_one_line_and_what_was_written_is_whole(
    start_program: Start, tmp_path: Path
) -> None:
    if not may_mount():
        pytest.skip("no file system may be mounted here, in a namespace of our own")
    (tmp_path / "small.toml").write_text(SMALL)
    (tmp_path / "small").mkdir()
    sweep = (sys.executable, "-m", "laglab", "sweep", "small.toml", *SHORT, "--out", "small/out")
    script = MOUNTED.format(size=40) + '; "$@"; code=$?; cp -r small/out kept; exit $code'
    process = start_program("unshare", "-rm", "sh", "-c", script, "sh", *sweep)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 4, errors
    assert len(errors.splitlines()) == 1
    assert errors.startswith("laglab: cannot write small/out/cells/")
    assert "No space left on device" in errors
    left = list((tmp_path / "kept" / "cells").iterdir())
    assert left
    for path in left:
        content = path.read_bytes()
        assert content[:4] == content[-4:] == b"PAR1"
