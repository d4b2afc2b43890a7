"""What `python -m build` makes for a release: complete, accepted by indexes, the same twice."""

import hashlib
import io
import shutil
import tarfile
import tomllib
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from laglab_fmu.compiler import PLATFORMS

from .environments import Environment
from .page import build, in_shell, releasing

ROOT = Path(__file__).parents[2]
VERSION = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["version"]

pytestmark = [pytest.mark.slow, pytest.mark.timeout(1500)]


def test_the_wheel_is_for_every_platform(wheel: Path) -> None:
    assert wheel.name == f"laglab-{VERSION}-py3-none-any.whl"
    with zipfile.ZipFile(wheel) as archive:
        assert b"Root-Is-Purelib: true" in archive.read(f"laglab-{VERSION}.dist-info/WHEEL")
        fmus = [name for name in archive.namelist() if name.endswith(".fmu")]
        assert len(fmus) >= 3
        for fmu in fmus:
            inside = zipfile.ZipFile(io.BytesIO(archive.read(fmu))).namelist()
            folders = {name.split("/")[1] for name in inside if name.startswith("binaries/")}
            version_2 = Path(fmu).stem.endswith("2")
            assert folders == {
                platform.fmi2_folder if version_2 else platform.fmi3_folder
                for platform in PLATFORMS
            }


def test_indexes_accept_them(release: Path) -> None:
    checks = [*releasing("twine"), *releasing("check_wheel")]
    assert len(checks) == 2
    for check in checks:
        done = in_shell(check, release.parent)
        assert done.returncode == 0, done.stdout


def test_the_sdist_is_the_repository(release: Path) -> None:
    """With its tests and docs, so that a distribution can package and test it."""
    with tarfile.open(release / f"laglab-{VERSION}.tar.gz") as archive:
        inside = {name.partition("/")[2] for name in archive.getnames()}
    files = (
        path.relative_to(release.parent) for path in release.parent.rglob("*") if path.is_file()
    )
    assert inside == {str(file) for file in files if file.parts[0] != "dist"} | {"PKG-INFO"}


def test_two_builds_have_one_hash(release: Path, tmp_path: Path) -> None:
    without = shutil.ignore_patterns("dist")
    again = build(Path(shutil.copytree(release.parent, tmp_path / "elsewhere", ignore=without)))
    for file in release.iterdir():
        first, second = (
            hashlib.sha256((folder / file.name).read_bytes()).hexdigest()
            for folder in (release, again)
        )
        assert first == second, file.name


@pytest.mark.parametrize("which", ["oldest", "newest"])
def test_the_wheel_runs_where_nothing_else_is(
    which: str,
    wheel: Path,
    pythons: dict[tuple[int, int], str],
    environment: Callable[[str], Environment],
    here: Callable[[str], str],
    tmp_path: Path,
) -> None:
    """On another Python, with binaries from another compiler: the same run, byte for byte."""
    versions = list(pythons)
    if which == "newest" and len(versions) == 1:
        pytest.skip(f"there is no Python here but {versions[0]}")
    clean = environment(pythons[versions[0 if which == "oldest" else -1]])
    clean.install(f"laglab[run] @ {wheel.as_uri()}")
    assert clean.laglab("--version") == f"laglab {VERSION}\n"
    for run in ("fig6", "lab-car --duration 1", "lab-radio --transport serial --duration 1"):
        name = run.split()[0]
        clean.laglab(f"run {run} --out {name}")
        here(f"run {run} --out {name}")
        traces = [folder / name / "trace.csv" for folder in (clean.folder, tmp_path)]
        assert traces[0].read_bytes() == traces[1].read_bytes()
    clean.laglab("protocol lint")
    clean.laglab("protocol generate --lang C generated")
