"""A release, built once for all of the tests' processes, and environments to install it into."""

import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from .environments import Environment, said
from .page import build

Clone = Callable[[Path], Path]


@pytest.fixture(scope="session")
def release(tmp_path_factory: pytest.TempPathFactory, clone_into: Clone) -> Path:
    """The folder with the sdist and the wheel, built in a clone where git has nothing to say."""
    fcntl = pytest.importorskip("fcntl")
    shared = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        shared = shared.parent
    clone = shared / "release"
    with (shared / "release.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        return clone / "dist" if clone.exists() else build(clone_into(clone))


@pytest.fixture(scope="session")
def wheel(release: Path) -> Path:
    return next(release.glob("*.whl"))


@pytest.fixture(scope="session")
def pythons() -> dict[tuple[int, int], str]:
    """An interpreter of each version from 3.11 on, oldest first."""
    ask = "import sys; print(*sys.version_info[:2])"
    found = {}
    for candidate in _candidates():
        done = subprocess.run([candidate, "-c", ask], capture_output=True, text=True, check=False)
        if done.returncode == 0:  # a version manager's stand-in may be for one that is not chosen
            major, minor = map(int, done.stdout.split())
            found[major, minor] = candidate
    return {version: found[version] for version in sorted(found) if version >= (3, 11)}


def _candidates() -> Iterator[str]:
    """On the PATH, and beside this one, where version managers lay them."""
    for minor in range(11, 20):
        if path := shutil.which(f"python3.{minor}"):
            yield path
    for beside in Path(sys.base_prefix).parent.glob("*/bin/python3"):
        yield str(beside)


@pytest.fixture
def environment(tmp_path: Path) -> Callable[[str], Environment]:
    """A fresh virtual environment of the given Python."""
    return lambda python: Environment(python, tmp_path)


@pytest.fixture
def here(tmp_path: Path) -> Callable[[str], str]:
    """The same command in the environment of the tests."""
    return lambda line: said([sys.executable, "-m", "laglab", *line.split()], tmp_path)
