"""A browser for all tests of pages, and runs for them to show."""

import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pytest

from laglab import Run
from laglab.interface import run

from .browser import Browser, Tab, browser, chromium


@pytest.fixture(scope="session")
def chromium_(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    program = chromium()
    if program is None:
        pytest.skip("there is no chromium here: no page was looked at")
    with browser(program, tmp_path_factory.mktemp("chromium")) as running:
        yield running


@pytest.fixture
def tab(chromium_: Browser) -> Iterator[Tab]:
    with chromium_.tab() as opened:
        yield opened


@pytest.fixture(scope="session")
def radio(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Over a bad link, with half a second of silence."""
    return run("lab-radio", {"duration": 5.0}, out=tmp_path_factory.mktemp("runs") / "radio")


@pytest.fixture(scope="session")
def pushed(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Over an ideal link; somebody pushes the robot."""
    told = {"duration": 5.0, "plant.event": [{"at": 3.0, "by": [0.5, 0.0, 0.0]}]}
    return run("lab", told, out=tmp_path_factory.mktemp("runs") / "pushed")


@pytest.fixture
def page(tmp_path: Path) -> Path:
    return tmp_path / "page.html"


Start = Callable[..., "subprocess.Popen[str]"]


@pytest.fixture
def start(start_program: Start) -> Start:
    """Start ``laglab ARGUMENTS`` in the background; whatever still runs at the end is ended."""
    return partial(start_program, sys.executable, "-m", "laglab")
