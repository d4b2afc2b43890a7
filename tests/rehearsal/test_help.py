"""What the command says of itself: help, version, names, completion; and all in 80 columns."""

import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest

import laglab
from laglab.command import main
from laglab.scenario import shipped_names
from laglab_control import ESTIMATORS

COLUMNS = 80


def said(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    """On standard output; it ends well."""
    capsys.readouterr()
    with pytest.raises(SystemExit) as ended:
        main(arguments)
    assert ended.value.code == 0
    return capsys.readouterr().out


GROUPS = ("bench", "fmu", "link", "plant", "protocol")


@pytest.mark.parametrize("group", [(), *((each,) for each in GROUPS)])
def test_a_group_alone_shows_its_help(
    group: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    """A line for each command, whole."""
    alone = said([*group], capsys)
    assert alone == said([*group, "--help"], capsys)
    _, commands = alone.split("\nCommands:\n")
    assert "..." not in commands
    assert all(line.rstrip().endswith(".") for line in commands.splitlines())


def test_a_command_does_not_wait_for_the_others() -> None:
    """To import them all would take longer than it does."""
    script = "import sys; from laglab.command import run_command; run_command(['scenarios']); "
    loaded = "print(*(name for name in sys.modules if name.startswith('laglab.commands.')))"
    done = subprocess.run([sys.executable, "-c", script + loaded], capture_output=True, text=True)
    *_, names = done.stdout.splitlines()
    assert "laglab.commands.parts.scenarios" in names.split()
    assert not {"laglab.commands.bench", "laglab.commands.runs.run"} & set(names.split())


def test_the_version_is_the_installed_one(capsys: pytest.CaptureFixture[str]) -> None:
    assert said(["--version"], capsys) == f"laglab {version('laglab')}\n"
    assert laglab.__version__ == version("laglab")


def test_the_estimators_are_listed_with_what_they_are(capsys: pytest.CaptureFixture[str]) -> None:
    listed = " ".join(said(["estimators"], capsys).split())
    asked = "".join(said(["run", "--help"], capsys).split())  # lines break at hyphens too
    for name, kind in ESTIMATORS.items():
        assert f"{name} laglab {kind.description}" in listed
    assert f"furtheronesshadowit:{','.join(ESTIMATORS)},aplug-in" in asked


@pytest.mark.parametrize(
    ("typed", "offered"),
    [
        ("laglab pro", {"protocol"}),
        ("laglab run f", {name for name in shipped_names() if name.startswith("f")}),
        ("laglab run fig6 --estimator popf-", {"popf-printed", "popf-exact"}),
        ("laglab replay robot.tlog --estimator r", set()),
    ],
)
def test_shells_complete_commands_scenarios_and_estimators(
    typed: str,
    offered: set[str],
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("_LAGLAB_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", typed)
    monkeypatch.setenv("COMP_CWORD", str(len(typed.split()) - 1))
    assert set(said([], capsys).split()) == offered


@pytest.mark.slow
def test_no_table_is_wider_than_80_columns(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", str(COLUMNS))
    short = ["--duration", "0.5"]
    replayed = [f"--estimator={name}" for name, kind in ESTIMATORS.items() if kind.predicts]
    for arguments in (
        ["scenarios"],
        ["estimators"],
        ["run", "lab-radio", *short, "--transport", "inline", "--out", "run"],
        ["replay", "run/robot.tlog", *replayed],
        ["errata", *short, "--seeds", "1"],
        ["consistency", *short, "--seeds", "2", "--workers", "1"],
        ["trust", "--only", "two outages of 1 s", "--seeds", "1", "--workers", "1"],
    ):
        for line in said(arguments, capsys).splitlines():
            assert len(line) <= COLUMNS, line
            assert "…" not in line
