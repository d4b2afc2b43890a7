"""Every command in the README does what it says."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
COMMANDS = [
    line
    for block in re.findall(r"```sh\n(.*?)```", README, re.DOTALL)
    for line in block.splitlines()
    if line
]
INSTALL_AND_RUN, INSTALL_AND_TEST = (line for line in COMMANDS if "-m venv" in line)
TWO_SIDES = [line for line in COMMANDS if line.startswith(("laglab gateway", "laglab controller"))]
OTHERS = [line for line in COMMANDS if line.startswith("laglab") and line not in TWO_SIDES]


def arguments(command: str) -> list[str]:
    return [sys.executable, "-m", *shlex.split(command)]


def test_nothing_in_the_readme_is_left_out() -> None:
    assert {INSTALL_AND_RUN, INSTALL_AND_TEST, *TWO_SIDES, *OTHERS} == set(COMMANDS)


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_each_command_works(tmp_path: Path) -> None:
    for command in OTHERS:
        result = subprocess.run(
            arguments(command),
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
        assert result.returncode == 0, f"{command}: {result.stderr}"
        assert result.stdout


def test_the_two_sides_find_each_other(tmp_path: Path) -> None:
    sides = [
        subprocess.Popen(arguments(command), cwd=tmp_path, stderr=subprocess.PIPE, text=True)
        for command in TWO_SIDES
    ]
    try:
        for side in sides:
            _, errors = side.communicate(timeout=60)
            assert side.returncode == 0, errors
    finally:
        for side in sides:
            side.kill()
            side.communicate()
    assert (tmp_path / "runs" / "gateway" / "trace.csv").exists()


def test_ci_runs_the_commands_of_the_pages() -> None:
    script = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    found = [
        subprocess.run(["bash", "-c", grep], cwd=ROOT, capture_output=True, text=True, check=True)
        for grep in re.findall(r"\$\((grep .*)\)", script)
    ]
    of_the_readme, of_contributing = (each.stdout.strip() for each in found)
    assert of_the_readme == INSTALL_AND_TEST
    assert of_contributing.startswith(".venv/bin/coverage run ")


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_a_bare_clone_installs_and_runs(bare_clone: Path) -> None:
    result = subprocess.run(
        ["bash", "-c", INSTALL_AND_RUN], cwd=bare_clone, capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stderr
    assert "converged" in result.stdout
    assert (bare_clone / "runs" / "fig6" / "figure.png").exists()
    installed = bare_clone / ".venv" / "bin" / "laglab"
    subprocess.run([installed, "fmu", "build", "--out", "built"], cwd=bare_clone, check=True)
    assert sorted(path.name for path in (bare_clone / "built").iterdir()) == [
        "Car2.fmu",
        "Car3.fmu",
        "CarFleet3.fmu",
        "Fleet3.fmu",
        "Omni2.fmu",
        "Omni3.fmu",
        "OmniFleet3.fmu",
        "Robot2.fmu",
        "Robot3.fmu",
    ]
