"""The FMUs under test, built once from the sources as they are, and fmpy instances of them."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import fmpy
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Model, FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Model, FMU3Slave

from laglab_fmu import build_fmus
from laglab_fmu import slave as slave_module
from laglab_fmu.compiler import host_platform
from laglab_fmu.models import Kind, model_of, token


class Face:
    """An fmpy instance; calls that differ between the versions have one name here."""

    def __init__(self, name: str, kind: str, folder: Path, debug: bool, **options: Any) -> None:
        self.version, self.kind, self.model = int(name[-1]), kind, model_of(name)
        self.messages: list[tuple[int, str, str]] = []
        arguments = {
            "guid": token(name),
            "modelIdentifier": name[:-1],
            "unzipDirectory": str(folder),
        }
        if self.version == 2:
            platform = host_platform()
            inside = f"binaries/{platform.fmi2_folder}/{name[:-1]}{platform.suffix}"
            arguments["libraryPath"] = str(folder / inside)
        self.fmu: Any = _CLASSES[self.version, kind](**arguments)
        if self.version == 2:
            callbacks = fmi2CallbackFunctions()
            callbacks.logger = fmi2CallbackLoggerTYPE(lambda _, _name, *entry: self._logged(*entry))
            self.fmu.instantiate(callbacks=callbacks, loggingOn=debug)
        else:
            self.fmu.instantiate(
                loggingOn=debug, logMessage=lambda _, *entry: self._logged(*entry), **options
            )

    def _logged(self, status: int, category: bytes, text: bytes) -> None:
        self.messages.append((status, category.decode(), text.decode()))

    def set(self, **values: float) -> None:
        """Sets variables by name."""
        for name, value in values.items():
            [reference] = self.references(name)
            kind = self.model.variables[reference].kind
            setter = getattr(self.fmu, "set" + _TYPE_NAMES[kind][self.version - 2])
            setter([reference], [value])

    def get(self, *names: str) -> list[float]:
        """Real values by name."""
        getter = self.fmu.getReal if self.version == 2 else self.fmu.getFloat64
        return list(getter(self.references(*names)))

    def references(self, *names: str) -> list[int]:
        """Value references by name."""
        return [self.model.reference[name] for name in names]

    def start(self, time: float = 0.0, stop: float | None = None, **values: float) -> None:
        """Sets parameters and leaves initialization mode."""
        self.set(**values)
        experiment = {"startTime": time, "stopTime": stop}
        if self.version == 2:
            self.fmu.setupExperiment(**experiment)
            self.fmu.enterInitializationMode()
        else:
            self.fmu.enterInitializationMode(**experiment)
        self.fmu.exitInitializationMode()

    def step(self, time: float, step: float = 0.01) -> None:
        self.fmu.doStep(time, step)

    def save(self) -> Any:
        return self.fmu.getFMUstate() if self.version == 2 else self.fmu.getFMUState()

    def restore(self, state: Any) -> None:
        (self.fmu.setFMUstate if self.version == 2 else self.fmu.setFMUState)(state)

    def free(self, state: Any) -> None:
        (self.fmu.freeFMUstate if self.version == 2 else self.fmu.freeFMUState)(state)

    def serialize(self, state: Any) -> bytes:
        fmu = self.fmu
        return bytes((fmu.serializeFMUstate if self.version == 2 else fmu.serializeFMUState)(state))

    def deserialize(self, data: bytes) -> Any:
        fmu = self.fmu
        return (fmu.deSerializeFMUstate if self.version == 2 else fmu.deserializeFMUState)(data)

    def packed(self) -> bytes:
        """All that it is, serialized."""
        state = self.save()
        data = self.serialize(state)
        self.free(state)
        return data

    @contextmanager
    def refused(self, status: int, *words: str) -> Iterator[None]:
        """Expects a call to fail with this status and to log one line with these words."""
        self.messages.clear()
        with pytest.raises(FMICallException) as error:
            yield
        assert error.value.status == status
        [(logged, category, line)] = self.messages
        assert (logged, category) == (status, _CATEGORIES[status])
        assert "\n" not in line
        assert all(word in line for word in words), line

    def become(self, data: bytes) -> None:
        """What another was when it was packed."""
        state = self.deserialize(data)
        self.restore(state)
        self.free(state)


_CLASSES = {
    (2, "CoSimulation"): FMU2Slave,
    (2, "ModelExchange"): FMU2Model,
    (3, "CoSimulation"): FMU3Slave,
    (3, "ModelExchange"): FMU3Model,
}
_CATEGORIES = {2: "logStatusDiscard", 3: "logStatusError"}
_TYPE_NAMES = {
    Kind.FLOAT64: ("Real", "Float64"),
    Kind.INT32: ("Integer", "Int32"),
    Kind.ENUMERATION: ("Integer", "Int64"),
    Kind.BOOLEAN: ("Boolean", "Boolean"),
    Kind.UINT64: ("", "UInt64"),
}
MakeFace = Callable[..., Face]


@pytest.fixture(scope="session")
def fmus(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The FMUs by file name without suffix."""
    return {path.stem: path for path in build_fmus(tmp_path_factory.mktemp("fmus"))}


@pytest.fixture(scope="session")
def extracted(fmus: dict[str, Path], tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The same, unpacked."""
    folders = {name: tmp_path_factory.mktemp(name) for name in fmus}
    for name, path in fmus.items():
        fmpy.extract(path, folders[name])
    return folders


@pytest.fixture(autouse=True)
def use_fresh_fmus(fmus: dict[str, Path], monkeypatch: pytest.MonkeyPatch) -> None:
    """Robots open the FMUs of this test run, not what an earlier installation left."""
    monkeypatch.setattr(slave_module, "built", lambda name: fmus[Path(name).stem])


@pytest.fixture
def make_face(extracted: dict[str, Path]) -> Iterator[MakeFace]:
    """`make_face("Robot3", "CoSimulation")`: an instance that lives as long as the test."""
    made: list[Face] = []

    def make(name: str, kind: str, debug: bool = False, **options: Any) -> Face:
        made.append(Face(name, kind, extracted[name], debug, **options))
        return made[-1]

    yield make
    for face in made:
        face.fmu.freeInstance()
