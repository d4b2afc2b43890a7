"""The page on one's own filters, laws and paths: what it shows runs."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

import laglab as lab

PAGE = (Path(__file__).parents[2] / "docs" / "bring-your-own.md").read_text("utf-8")
FILES = re.findall(r"```python\n# (\w+\.py)\n(.*?)```", PAGE, flags=re.DOTALL)
(WAY,) = re.findall(r"```text\n(time.*?)```", PAGE, flags=re.DOTALL)
(TOML,) = re.findall(r"```toml\n(.*?)```", PAGE, flags=re.DOTALL)
COMMANDS = re.findall(r"^    (laglab .*)$", PAGE, flags=re.MULTILINE)


def laglab(folder: Path, *arguments: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        [sys.executable, "-m", "laglab", *arguments],
        cwd=folder,
        check=False,
        capture_output=True,
        text=True,
        timeout=100,
    )


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """With the files that the page shows."""
    for name, text in FILES:
        (tmp_path / name).write_text(text)
    (tmp_path / "way.csv").write_text(WAY)
    return tmp_path


def test_every_block_of_code_is_tried() -> None:
    assert [name for name, _ in FILES] == ["mine.py", "slow.py"]
    assert PAGE.count("```python") == len(FILES)
    assert len(COMMANDS) > 8


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_each_command_does_what_it_says(folder: Path) -> None:
    for command in COMMANDS:
        done = laglab(folder, *shlex.split(command)[1:])
        assert done.returncode == 0, f"{command}: {done.stderr or done.stdout}"
        assert done.stdout


def test_the_scenario_it_shows_is_one(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    (folder / "own.toml").write_text(f"duration = 0.3\n{TOML}")
    run = lab.run("own.toml")
    assert run.scenario.estimator.kind == "mine:Inflated"
    assert set(run.summary.compare) == {"mine:Inflated", "delayed-ekf"}
