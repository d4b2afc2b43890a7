"""`laglab new`: what it makes is installed, found, checked and run."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Ended = Callable[..., Any]
Run = Callable[..., "subprocess.CompletedProcess[str]"]
pytestmark = pytest.mark.timeout(180)


@pytest.fixture
def installed(tmp_path: Path, ended: Ended) -> Callable[[str, str], Run]:
    """Makes a package, installs it into a folder, and gives what runs Python with that folder."""

    def install(kind: str, name: str) -> Run:
        assert ended("new", kind, name, "--out", tmp_path / "made").code == 0
        pip = [f"{sys.base_prefix}/bin/python3", "-m", "pip", "--python", sys.executable, "install"]
        options = ["-q", "--no-deps", "--no-build-isolation", "--target", str(tmp_path / "site")]
        package = str(tmp_path / "made" / name)
        done = subprocess.run(
            [*pip, *options, package], check=False, capture_output=True, text=True, timeout=120
        )
        assert done.returncode == 0, done.stderr

        def run(*arguments: str) -> "subprocess.CompletedProcess[str]":
            return subprocess.run(
                [sys.executable, "-m", *arguments],
                cwd=tmp_path,
                env={**os.environ, "PYTHONPATH": str(tmp_path / "site"), "COLUMNS": "200"},
                check=False,
                capture_output=True,
                text=True,
                timeout=100,
            )

        return run

    return install


@pytest.mark.parametrize(
    ("kind", "option"),
    [
        pytest.param("estimator", "--estimator", marks=pytest.mark.slow),
        ("law", "--law"),
    ],
)
def test_what_is_made_is_installed_listed_checked_and_run(
    installed: Callable[[str, str], Run], tmp_path: Path, kind: str, option: str
) -> None:
    run = installed(kind, "my-own")
    listed = run("laglab", f"{kind}s")
    assert "my-own" in listed.stdout
    assert "my-own 0.1.0" in listed.stdout
    checked = run("laglab", "check", "my-own")
    assert checked.returncode == 0, checked.stdout + checked.stderr
    told = ("--duration", "1", "--out", "run")
    done = run("laglab", "run", "lab", option, "my-own", *told)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "run" / "trace.csv").exists()
    tested = run("pytest", "-q", "-p", "no:cacheprovider", str(tmp_path / "made" / "my-own"))
    assert tested.returncode == 0, tested.stdout


@pytest.mark.parametrize("kind", ["estimator", "law", "plant"])
def test_each_template_keeps_its_interface(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ended: Ended, kind: str
) -> None:
    name = f"begun-{kind}"
    assert ended("new", kind, name, "--out", tmp_path).code == 0
    monkeypatch.chdir(tmp_path / name)
    checked = ended("check", f"begun_{kind}:Begun{kind.capitalize()}")
    assert checked.code == 0, checked
    assert f"keeps the interface of a{'n' * (kind == 'estimator')} {kind}" in checked.out


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("My Own", "a package's name is of small letters and digits"),
        ("-x", "No such option"),
        ("class", "Python has something of that name already"),
        ("none", "Python has something of that name already"),
        ("setup", "Python has something of that name already"),
        ("inf", "a scenario reads that as a number"),
        ("numpy", "Python has something of that name already"),
        ("delayed-ekf", "laglab has something of that name already"),
        ("polar", "laglab has something of that name already"),
        ("car", "laglab has something of that name already"),
        ("there", "there cannot be made: File exists"),
    ],
)
def test_what_cannot_be_made_is_one_line(
    tmp_path: Path, refused: Callable[..., str], name: str, said: str
) -> None:
    (tmp_path / "there").mkdir()
    assert said in refused("new", "law", name, "--out", tmp_path)


def test_what_cannot_be_made_whole_is_not_there(
    tmp_path: Path, refused: Callable[..., str]
) -> None:
    """The test's name is longer than the package's: too long for a file."""
    assert "File name too long" in refused("new", "law", "a" * 250, "--out", tmp_path, code=4)
    assert not list(tmp_path.iterdir())


def test_the_commands_that_are_told_can_be_copied(tmp_path: Path, ended: Ended) -> None:
    folder = tmp_path / "my laws"
    done = ended("new", "law", "begun-law", "--out", folder)
    assert f"pip install -e '{folder / 'begun-law'}'" in done.out
