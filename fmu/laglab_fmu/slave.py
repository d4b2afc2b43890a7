"""One FMU instance in co-simulation, through fmpy, its per-tick calls made on reused arrays.

FMPy's own methods make lists and arrays at each call, which costs more than the step itself. They
serve for the life cycle here; the rest calls the functions of the same library directly.
"""

import ctypes
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from typing import Any, Protocol

import fmpy
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Slave

from laglab_fmu.compiler import host_platform
from laglab_fmu.description import TOKEN
from laglab_fmu.errors import CallError, FmuNotBuiltError
from laglab_fmu.parameters import RobotParameters
from laglab_fmu.variables import MODEL_NAME, REFERENCE

VERSIONS = (2, 3)
DISCARD = 2
"""Statuses from here up mean that a call did not do what it was asked."""


def fmu_path(version: int) -> Path:
    """The installed Robot2.fmu or Robot3.fmu.

    Raises:
        ValueError: version is neither 2 nor 3.
        FmuNotBuiltError: it is not there.
    """
    if version not in VERSIONS:
        raise ValueError(f"FMI version is {version!r}; it must be 2 or 3")
    return built(f"{MODEL_NAME}{version}.fmu")


def built(name: str) -> Path:
    """The path of an FMU beside this file, checked to be there."""
    path = Path(__file__).parent / name
    if not path.is_file():
        raise FmuNotBuiltError(
            f"{path} is missing; run `laglab fmu build`, or install laglab again"
        )
    return path


class Slave(Protocol):
    """What both versions offer; `log` holds what the FMU has logged."""

    log: list[str]

    def initialize(self, parameters: RobotParameters) -> None: ...
    def reset(self) -> None: ...
    def free(self) -> None: ...
    def setter(self, names: Sequence[str], values: Any) -> Callable[[], int]: ...
    def getter(self, names: Sequence[str], values: Any) -> Callable[[], int]: ...
    def stepper(self, time: ctypes.c_double, step: ctypes.c_double) -> Callable[[], int]: ...


class Slave2:
    """FMI 2.0."""

    def __init__(self, folder: str) -> None:
        platform = host_platform()
        library = Path(folder, "binaries", platform.fmi2_folder, MODEL_NAME + platform.suffix)
        self.log: list[str] = []
        self.fmu = FMU2Slave(
            guid=TOKEN, modelIdentifier=MODEL_NAME, unzipDirectory=folder, libraryPath=str(library)
        )
        self.callbacks = fmi2CallbackFunctions()
        self.callbacks.logger = fmi2CallbackLoggerTYPE(self._logged)
        with _unloading_on_failure(self.fmu):
            self.fmu.instantiate(callbacks=self.callbacks)

    def _logged(
        self, _environment: Any, _name: bytes, _status: int, _category: bytes, message: bytes
    ) -> None:
        self.log.append(message.decode().replace("%%", "%"))

    def initialize(self, parameters: RobotParameters) -> None:
        floats = parameters.floats()
        self.fmu.setReal([REFERENCE[name] for name in floats], list(floats.values()))
        integers = [REFERENCE["seed"], REFERENCE["integration"]]
        self.fmu.setInteger(integers, [parameters.seed, parameters.integration_number()])
        self.fmu.setBoolean([REFERENCE["noise"]], [parameters.noise])
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def reset(self) -> None:
        self.fmu.reset()

    def free(self) -> None:
        self.fmu.freeInstance()

    def setter(self, names: Sequence[str], values: Any) -> Callable[[], int]:
        return self._call("fmi2SetReal", *_references(names), values)

    def getter(self, names: Sequence[str], values: Any) -> Callable[[], int]:
        return self._call("fmi2GetReal", *_references(names), values)

    def stepper(self, time: ctypes.c_double, step: ctypes.c_double) -> Callable[[], int]:
        return self._call("fmi2DoStep", time, step, ctypes.c_int(1))

    def _call(self, name: str, *arguments: Any) -> Callable[[], int]:
        return partial(self.fmu.dll[name], ctypes.c_void_p(self.fmu.component), *arguments)


class Slave3:
    """FMI 3.0."""

    def __init__(self, folder: str) -> None:
        self.log: list[str] = []
        self.fmu = FMU3Slave(guid=TOKEN, modelIdentifier=MODEL_NAME, unzipDirectory=folder)
        with _unloading_on_failure(self.fmu):
            self.fmu.instantiate(logMessage=self._logged)

    def _logged(self, _environment: Any, _status: int, _category: bytes, message: bytes) -> None:
        self.log.append(message.decode())

    def initialize(self, parameters: RobotParameters) -> None:
        floats = parameters.floats()
        self.fmu.setFloat64([REFERENCE[name] for name in floats], list(floats.values()))
        self.fmu.setInt32([REFERENCE["seed"]], [parameters.seed])
        self.fmu.setInt64([REFERENCE["integration"]], [parameters.integration_number()])
        self.fmu.setBoolean([REFERENCE["noise"]], [parameters.noise])
        self.fmu.enterInitializationMode(startTime=0.0)
        self.fmu.exitInitializationMode()

    def reset(self) -> None:
        self.fmu.reset()

    def free(self) -> None:
        self.fmu.freeInstance()

    def setter(self, names: Sequence[str], values: Any) -> Callable[[], int]:
        return self._call(
            "fmi3SetFloat64", *_references(names), values, ctypes.c_size_t(len(values))
        )

    def getter(self, names: Sequence[str], values: Any) -> Callable[[], int]:
        return self._call(
            "fmi3GetFloat64", *_references(names), values, ctypes.c_size_t(len(values))
        )

    def stepper(self, time: ctypes.c_double, step: ctypes.c_double) -> Callable[[], int]:
        flags = [ctypes.byref(ctypes.c_bool()) for _ in range(3)]
        last = ctypes.byref(ctypes.c_double())
        return self._call("fmi3DoStep", time, step, ctypes.c_bool(True), *flags, last)

    def _call(self, name: str, *arguments: Any) -> Callable[[], int]:
        return partial(self.fmu.dll[name], ctypes.c_void_p(self.fmu.component), *arguments)


@contextmanager
def _unloading_on_failure(fmu: FMU2Slave | FMU3Slave) -> Iterator[None]:
    """A loaded library would keep the extracted folder from being removed on Windows."""
    try:
        yield
    except Exception:
        fmu.freeLibrary()
        raise


def _references(names: Sequence[str]) -> tuple[Any, ctypes.c_size_t]:
    references = (ctypes.c_uint32 * len(names))(*(REFERENCE[name] for name in names))
    return references, ctypes.c_size_t(len(names))


def open_slave(version: int, stack: ExitStack) -> Slave:
    """Extracts the FMU, loads it and makes an instance; `stack` undoes all of it.

    Raises:
        FmuNotBuiltError, CallError: it is not there, or it does not start.
    """
    folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="laglab-fmu-"))
    try:
        fmpy.extract(fmu_path(version), folder)
        slave: Slave = Slave2(folder) if version == 2 else Slave3(folder)
    except Exception as error:  # fmpy raises nothing narrower
        raise CallError(
            f"{fmu_path(version)} does not start ({error}); run `laglab fmu build`"
        ) from error
    stack.callback(slave.free)
    return slave


def initialize(slave: Slave, parameters: RobotParameters) -> None:
    """Gives a fresh or reset instance its parameters and starts it.

    Raises:
        CallError: the FMU refused a value; names it.
    """
    slave.log.clear()
    try:
        slave.initialize(parameters)
    except FMICallException as error:
        raise CallError("; ".join(slave.log) or str(error)) from error
