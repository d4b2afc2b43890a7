"""Other people's FMUs, built once."""

from pathlib import Path

import pytest

from .building import CO_SIMULATION, MODEL_EXCHANGE, in_python, rover, rover_library


@pytest.fixture(scope="session")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The rover's."""
    return rover_library(tmp_path_factory.mktemp("library"))


@pytest.fixture(scope="session")
def fmus(tmp_path_factory: pytest.TempPathFactory, library: Path) -> Path:
    """rover.fmu, rover-me.fmu, Barrow.fmu, Tray.fmu."""
    folder = tmp_path_factory.mktemp("fmus")
    rover(folder / "rover.fmu", library, [MODEL_EXCHANGE, CO_SIMULATION])
    rover(folder / "rover-me.fmu", library, [MODEL_EXCHANGE])
    in_python("pythonfmu3", "barrow", folder)
    in_python("pythonfmu3", "sled", folder)
    in_python("pythonfmu", "tray", folder)
    return folder
