"""What all tests share."""

import compileall
import re
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
COMPONENTS = ("fmu", "protocol", "gateway", "controller", "rehearsal")


def pytest_configure(config: pytest.Config) -> None:
    """Compile the packages once: hundreds of the tests' processes would each do it again."""
    if not hasattr(config, "workerinput"):
        for component in COMPONENTS:
            compileall.compile_dir(ROOT / component, quiet=2)


Start = Callable[..., "subprocess.Popen[str]"]


@pytest.fixture
def start_program(tmp_path: Path) -> Iterator[Start]:
    """Start a program in the background; whatever still runs at the end is ended."""
    running: list[subprocess.Popen[str]] = []

    def call(*command: object) -> "subprocess.Popen[str]":
        process = subprocess.Popen(
            list(map(str, command)),
            cwd=tmp_path,
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
        found = re.search(r"listening on udpin://127\.0\.0\.1:(\d+)", line)
        assert found, line
        return found[1]

    return read
