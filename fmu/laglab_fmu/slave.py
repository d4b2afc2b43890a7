"""One FMU instance in co-simulation, through fmpy, its per-tick calls made on reused arrays.

FMPy's own methods make lists and arrays at each call, which costs more than the step itself. Here
they serve for the life cycle; all else calls the functions of the same library directly.
"""

import ctypes
import os
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from typing import Any, Protocol

import fmpy
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Slave

from laglab_fmu.compiler import host_platform
from laglab_fmu.errors import CallError, FmuNotBuiltError
from laglab_fmu.models import ROBOT, Kind, Model, Role, model_named, token
from laglab_fmu.parameters import ShippedParameters, values
from laglab_fmu.unpacked import own_folder

VERSIONS = (2, 3)


_SETTERS_2 = {
    "setReal": (Kind.FLOAT64,),
    "setInteger": (Kind.INT32, Kind.ENUMERATION),
    "setBoolean": (Kind.BOOLEAN,),
}
_SETTERS_3 = {
    "setFloat64": (Kind.FLOAT64,),
    "setInt32": (Kind.INT32,),
    "setInt64": (Kind.ENUMERATION,),
    "setBoolean": (Kind.BOOLEAN,),
}
"""FMPy's method for parameters of which kinds."""
Call = Callable[[], int]
"""An FMI function with all its arguments; gives its status, 0 when it did what it was asked."""


def fmu_path(version: int, name: str = ROBOT.name) -> Path:
    """The installed Robot2.fmu or Robot3.fmu, or another robot's.

    Raises:
        ValueError: version is neither 2 nor 3.
        FmuNotBuiltError: it is not there.
    """
    if version not in VERSIONS:
        raise ValueError(f"FMI version is {version!r}; it must be 2 or 3")
    return built(f"{name}{version}.fmu")


def fleet_path(name: str = ROBOT.name) -> Path:
    """The installed Fleet3.fmu, or another robot's: CarFleet3.fmu, OmniFleet3.fmu.

    Raises:
        ValueError: no robot that ships is called so.
        FmuNotBuiltError: it is not there.
    """
    return built(f"{model_named(name).fleet}3.fmu")


def built(name: str) -> Path:
    """The path of an FMU beside this file, checked to be there."""
    path = Path(__file__).parent / name
    if not path.is_file():
        raise FmuNotBuiltError(
            f"{path} is missing; run `laglab fmu build`, or install laglab again"
        )
    return path


class Slave(Protocol):
    """What both versions offer. Arrays hold all robots' values of one variable, then the next's."""

    log: list[str]
    """What the FMU has logged."""

    def initialize(self, robots: Sequence[ShippedParameters]) -> None: ...
    def reset(self) -> None: ...
    def free(self) -> None: ...
    def setter(self, names: Sequence[str], array: ctypes.c_void_p, size: int) -> Call: ...
    def getter(self, names: Sequence[str], array: ctypes.c_void_p, size: int) -> Call: ...
    def stepper(self, time: ctypes.c_double, step: ctypes.c_double) -> Call: ...


class Slave2:
    """FMI 2.0: one robot, the differential drive."""

    def __init__(self, folder: str) -> None:
        platform = host_platform()
        library = Path(folder, "binaries", platform.fmi2_folder, ROBOT.name + platform.suffix)
        self.log: list[str] = []
        self.fmu = FMU2Slave(
            guid=token(f"{ROBOT.name}2"),
            modelIdentifier=ROBOT.name,
            unzipDirectory=folder,
            libraryPath=str(library),
        )
        self.callbacks = fmi2CallbackFunctions()
        self.callbacks.logger = fmi2CallbackLoggerTYPE(self._logged)
        with _unloading_on_failure(self.fmu):
            self.fmu.instantiate(callbacks=self.callbacks)

    def _logged(self, _where: Any, _name: bytes, _status: int, _kind: bytes, text: bytes) -> None:
        self.log.append(text.decode().replace("%%", "%"))

    def initialize(self, robots: Sequence[ShippedParameters]) -> None:
        _set_parameters(self.fmu, ROBOT, _SETTERS_2, robots)
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def reset(self) -> None:
        self.fmu.reset()

    def free(self) -> None:
        self.fmu.freeInstance()

    def setter(self, names: Sequence[str], array: ctypes.c_void_p, _size: int) -> Call:
        return self._call("fmi2SetReal", *_counted(ROBOT, names), array)

    def getter(self, names: Sequence[str], array: ctypes.c_void_p, _size: int) -> Call:
        return self._call("fmi2GetReal", *_counted(ROBOT, names), array)

    def stepper(self, time: ctypes.c_double, step: ctypes.c_double) -> Call:
        return self._call("fmi2DoStep", time, step, ctypes.c_int(1))

    def _call(self, name: str, *arguments: Any) -> Call:
        return partial(self.fmu.dll[name], ctypes.c_void_p(self.fmu.component), *arguments)


class Slave3:
    """FMI 3.0: one robot or a fleet."""

    def __init__(self, folder: str, model: Model = ROBOT, fleet: bool = False) -> None:
        self.log: list[str] = []
        self.model, self.fleet = model, fleet
        name = model.fleet if fleet else model.name
        self.fmu = FMU3Slave(guid=token(f"{name}3"), modelIdentifier=name, unzipDirectory=folder)
        with _unloading_on_failure(self.fmu):
            self.fmu.instantiate(logMessage=self._logged)

    def _logged(self, _environment: Any, _status: int, _category: bytes, message: bytes) -> None:
        self.log.append(message.decode())

    def initialize(self, robots: Sequence[ShippedParameters]) -> None:
        if self.fleet:
            self.fmu.enterConfigurationMode()
            self.fmu.setUInt64([self.model.reference["robots"]], [len(robots)])
            self.fmu.exitConfigurationMode()
        _set_parameters(self.fmu, self.model, _SETTERS_3, robots)
        self.fmu.enterInitializationMode(startTime=0.0)
        self.fmu.exitInitializationMode()

    def reset(self) -> None:
        self.fmu.reset()

    def free(self) -> None:
        self.fmu.freeInstance()

    def setter(self, names: Sequence[str], array: ctypes.c_void_p, size: int) -> Call:
        return self._on_array("fmi3SetFloat64", names, array, size)

    def getter(self, names: Sequence[str], array: ctypes.c_void_p, size: int) -> Call:
        return self._on_array("fmi3GetFloat64", names, array, size)

    def _on_array(self, call: str, names: Sequence[str], array: ctypes.c_void_p, size: int) -> Call:
        return self._call(call, *_counted(self.model, names), array, ctypes.c_size_t(size))

    def stepper(self, time: ctypes.c_double, step: ctypes.c_double) -> Call:
        flags = [ctypes.byref(ctypes.c_bool()) for _ in range(3)]
        last = ctypes.byref(ctypes.c_double())
        return self._call("fmi3DoStep", time, step, ctypes.c_bool(True), *flags, last)

    def _call(self, name: str, *arguments: Any) -> Call:
        return partial(self.fmu.dll[name], ctypes.c_void_p(self.fmu.component), *arguments)


def _set_parameters(
    fmu: FMU2Slave | FMU3Slave,
    model: Model,
    setters: Mapping[str, Sequence[Kind]],
    robots: Sequence[ShippedParameters],
) -> None:
    rows = [robot.by_name() for robot in robots]
    for setter, kinds in setters.items():
        parameters = [v for v in model.variables if v.role is Role.PARAMETER and v.kind in kinds]
        names = [each.name for each in parameters]
        getattr(fmu, setter)(_references(model, names), values(rows, names))


def _references(model: Model, names: Sequence[str]) -> list[int]:
    return [model.reference[name] for name in names]


def _counted(model: Model, names: Sequence[str]) -> tuple[Any, ctypes.c_size_t]:
    references = _references(model, names)
    return (ctypes.c_uint32 * len(names))(*references), ctypes.c_size_t(len(names))


@contextmanager
def _unloading_on_failure(fmu: FMU2Slave | FMU3Slave) -> Iterator[None]:
    """A loaded library would keep the extracted folder from being removed on Windows."""
    try:
        yield
    except Exception:
        fmu.freeLibrary()
        raise


def open_slave(path: Path, make: Callable[[str], Slave], stack: ExitStack) -> Slave:
    """Extracts an FMU's binary for this machine and makes an instance of it; `stack` undoes both.

    Raises:
        CallError: it does not start.
    """
    folder = own_folder()
    stack.callback(shutil.rmtree, folder, ignore_errors=True)
    folder.mkdir(mode=0o700)  # after the callback, as an interrupt may come in between
    try:
        _extract(path, folder)
        slave = make(str(folder))
    except CallError:
        raise
    except Exception as error:  # fmpy raises nothing narrower
        raise CallError(f"{path} does not start ({error}); run `laglab fmu build`") from error
    stack.callback(slave.free)
    if os.name == "posix":
        # A loaded library needs its file no more, and a process that is killed cleans nothing up.
        shutil.rmtree(folder)
    return slave


def _extract(path: Path, folder: Path) -> None:
    """Raises CallError, when it is not the file that is to blame."""
    try:
        fmpy.extract(path, str(folder), include=_is_needed)
    except OSError as error:
        if not path.is_file():
            raise
        raise CallError(f"{path} cannot be unpacked into {folder}: {error.strerror}") from error


def _is_needed(name: str) -> bool:
    platform = host_platform()
    own = tuple(f"binaries/{folder}/" for folder in (platform.fmi2_folder, platform.fmi3_folder))
    return name.startswith(own)


def initialize(slave: Slave, robots: Sequence[ShippedParameters]) -> None:
    """Gives a fresh or reset instance its parameters and starts it.

    Raises:
        CallError: the FMU refused a value; names it.
    """
    slave.log.clear()
    try:
        slave.initialize(robots)
    except FMICallException as error:
        raise CallError("; ".join(slave.log) or str(error)) from error
