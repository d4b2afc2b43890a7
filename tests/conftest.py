"""What all tests share."""

import compileall
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
COMPONENTS = ("fmu", "protocol", "gateway", "controller", "rehearsal")


def pytest_configure(config: pytest.Config) -> None:
    """Compile the packages once: hundreds of the tests' processes would each do it again."""
    if not hasattr(config, "workerinput"):
        for component in COMPONENTS:
            compileall.compile_dir(ROOT / component, quiet=2)
