"""An instance of somebody's FMU: from the file to what can be stepped, and what it logs."""

import shutil
from collections import deque
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import fmpy
from fmpy.fmi1 import FMICallException
from fmpy.simulation import (
    apply_start_values,
    instantiate_fmu,
    settable_in_initialization_mode,
    settable_in_instantiated,
)

from laglab_fmu.compiler import host_platform
from laglab_fmu.errors import CallError, FmuFileError
from laglab_fmu.foreign.file import DAMAGED, FmuFile, one_line
from laglab_fmu.foreign.wiring import Value
from laglab_fmu.unpacked import own_folder

KEPT = 100
"""Lines of what the FMU logs; older ones are forgotten."""


class LastLines:
    """What an FMU says of itself: the last lines."""

    def __init__(self) -> None:
        self.lines = deque[str](maxlen=KEPT)

    def hear(self, *told: Any) -> None:
        """FMI's logger, of either version: the text is its last argument."""
        *_, text = told
        line = (text or b"").decode(errors="replace") if isinstance(text, bytes) else str(text)
        self.lines.append(" ".join(line.split()))


@contextmanager
def instance(file: FmuFile, log: LastLines) -> Iterator[Any]:
    """FMPy's object for the FMU, not yet initialized; gone with its files when the context ends.

    Raises FmuFileError: it does not start.
    """
    interface = "CoSimulation" if file.interface() == "co-simulation" else "ModelExchange"
    folder = own_folder()
    try:
        folder.mkdir(mode=0o700)
        fmu = _started(file, interface, folder, log)
        try:
            yield fmu
        finally:
            fmu.freeInstance()
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _started(file: FmuFile, interface: str, folder: Path, log: LastLines) -> Any:
    needed = ("resources/", f"binaries/{file.folder}/")
    try:
        fmpy.extract(file.path, str(folder), include=lambda name: name.startswith(needed))
        (folder / "resources").mkdir(exist_ok=True)
        return instantiate_fmu(
            str(folder),
            file.description,
            interface,
            logger=log.hear,
            library_path=_library(file, interface, folder),
        )
    except DAMAGED as error:
        raise FmuFileError(f"{file.path} is damaged: {error}") from error
    except Exception as error:  # fmpy raises nothing narrower
        said = "; ".join((one_line(error).replace(f"{folder}/", ""), *log.lines))
        raise FmuFileError(f"{file.path} does not start: {said}") from error


def _library(file: FmuFile, interface: str, folder: Path) -> str | None:
    """The library's path: FMPy alone would look for FMI 2's in the folder of another processor."""
    if file.version != 2:
        return None
    offered = file.description.coSimulation
    if interface != "CoSimulation":
        offered = file.description.modelExchange
    name = offered.modelIdentifier + host_platform().suffix
    return str(folder / "binaries" / file.folder / name)


def initialize(file: FmuFile, fmu: Any, values: Mapping[str, Value]) -> None:
    """Starts a fresh or reset instance with these start values, by the FMU's names.

    Raises FmuFileError: one of them cannot be set; CallError: the FMU refuses one; and
    FMICallException.
    """
    left = dict(values)
    if file.version == 2:
        fmu.setupExperiment(startTime=0.0)
    left = _set(file, fmu, left, settable_in_instantiated)
    fmu.enterInitializationMode()
    left = _set(file, fmu, left, settable_in_initialization_mode)
    if left:
        raise FmuFileError(
            f"{file.path}: {', '.join(left)}: nobody but the FMU itself can set that"
        )
    fmu.exitInitializationMode()


def _set(file: FmuFile, fmu: Any, values: Mapping[str, Value], settable: Any) -> dict[str, Value]:
    """Sets them one by one, so that it can be said which was refused; returns the others."""
    left: dict[str, Value] = {}
    for name, value in values.items():
        try:
            left |= apply_start_values(fmu, file.description, {name: value}, settable)
        except FMICallException as error:
            raise CallError(f"{error.function} of {name} = {value} failed") from error
        except Exception as error:  # fmpy raises nothing narrower
            raise FmuFileError(f"{file.path}: {name} = {value!r}: {error}") from error
    return left
