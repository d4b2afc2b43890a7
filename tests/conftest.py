"""What all tests share."""

import compileall
import os
import re
import shutil
import signal
import subprocess
import sys
import venv
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from hypothesis import settings

# No deadline for one example: machines are shared, and now and then one stands still.
settings.register_profile("shared", deadline=None)
settings.load_profile("shared")

ROOT = Path(__file__).parents[1]
COMPONENTS = ("fmu", "protocol", "gateway", "controller", "rehearsal")


def pytest_configure(config: pytest.Config) -> None:
    """Compile the packages once: hundreds of the tests' processes would each do it again. And let
    them be interrupted, though who started us had us ignore that: children inherit it."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if not hasattr(config, "workerinput"):
        for component in COMPONENTS:
            compileall.compile_dir(ROOT / component, quiet=2)


def pytest_xdist_auto_num_workers(config: pytest.Config) -> int:
    """As many as processors; without the slow tests, which keep them busy, one more: the others
    wait for the clock for two fifths of their time."""
    return (os.cpu_count() or 1) + ("not slow" in config.option.markexpr)


@pytest.fixture(autouse=True)
def _no_module_is_anothers(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """What a test brought into its folder is gone with it: the next may have one of that name."""
    before = set(sys.modules)
    yield
    folders = str(tmp_path_factory.getbasetemp())
    for name in sys.modules.keys() - before:
        if str(getattr(sys.modules[name], "__file__", "")).startswith(folders):
            del sys.modules[name]


Start = Callable[..., "subprocess.Popen[str]"]


@pytest.fixture
def stack() -> Iterator[ExitStack]:
    """What a test opens on the way, and is closed at its end."""
    with ExitStack() as opened:
        yield opened


@pytest.fixture
def start_program(tmp_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Start]:
    """Start a program in the background; whatever still runs at the end is ended, and what it then
    leaves is where pytest's own folders are."""
    running: list[subprocess.Popen[str]] = []
    temporary = str(tmp_path_factory.mktemp("tmp"))

    def call(*command: object) -> "subprocess.Popen[str]":
        process = subprocess.Popen(
            list(map(str, command)),
            cwd=tmp_path,
            env=os.environ | {"TMPDIR": temporary},
            stderr=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        running.append(process)
        return process

    yield call
    for process in running:
        process.kill()
        process.communicate()


@pytest.fixture
def start(start_program: Start) -> Start:
    """The same, where no other is meant."""
    return start_program


@pytest.fixture
def listening_port() -> Callable[["subprocess.Popen[str]"], str]:
    """The UDP port on loopback that a gateway in the background says it listens on."""

    def read(gateway: "subprocess.Popen[str]") -> str:
        assert gateway.stderr is not None
        line = gateway.stderr.readline()
        found = re.search(r"(?:listening on|look on at) udpin://127\.0\.0\.1:(\d+)", line)
        assert found, line
        return found[1]

    return read


Clone = Callable[[Path], Path]


@pytest.fixture(scope="session")
def clone_into() -> Clone:
    """Copies the files that git tracks, and no others, into a new folder, which it gives."""

    def copy(folder: Path) -> Path:
        tracked = subprocess.check_output(["git", "ls-files", "-z"], cwd=ROOT, text=True)
        for name in filter(None, tracked.split("\0")):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
        return folder

    return copy


@pytest.fixture
def bare_clone(tmp_path: Path, clone_into: Clone) -> Path:
    """The files that git tracks, and no others."""
    return clone_into(tmp_path / "clone")


@pytest.fixture
def install_afresh(tmp_path: Path) -> Callable[..., Path]:
    """Installs into an environment of its own, whose Python it gives; the environment of the tests
    needs no pip of its own."""
    python = tmp_path / "environment" / "bin" / "python"
    pip = [f"{sys.base_prefix}/bin/python3", "-m", "pip", "--python", str(python), "install", "-q"]
    venv.create(tmp_path / "environment", with_pip=False)

    def install(what: str, clone: Path = ROOT) -> Path:
        subprocess.run([*pip, what], cwd=clone, check=True, capture_output=True, timeout=240)
        return python

    return install
