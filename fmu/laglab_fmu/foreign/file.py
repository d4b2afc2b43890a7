"""An FMU's file: what can be known of it without running it."""

import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Literal

import fmpy
from fmpy.model_description import (
    InterfaceType,
    ModelDescription,
    ModelVariable,
    ValidationError,
)

from laglab_fmu.compiler import host_platform
from laglab_fmu.errors import FmuFileError

Interface = Literal["co-simulation", "model exchange"]
SOURCES = "sources"
DAMAGED = (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError)
"""What zipfile says of an archive that is none, is cut off or overwritten, or packed strangely."""


@dataclass(frozen=True, eq=False)
class FmuFile:
    """A file that is an FMU, of FMI 2 or 3."""

    path: Path
    description: ModelDescription
    platforms: tuple[str, ...]
    """The folders of its binaries, as FMI names them."""
    has_sources: bool
    invalid: str = ""
    """What its model description does against the standard, though it can be read."""

    @classmethod
    def read(cls, path: Path) -> "FmuFile":
        """Reads an FMU. Raises FmuFileError: there is no such file, or it is none of FMI 2 or 3."""
        if path.is_dir():
            raise FmuFileError(f"{path} is a folder: an FMU is a zip archive of what is in it")
        if not path.is_file():
            raise FmuFileError(f"{path}: there is no such file")
        try:
            with zipfile.ZipFile(path) as archive:
                places = [PurePosixPath(name) for name in archive.namelist()]
            description, invalid = _described(path)
        except DAMAGED as error:
            raise FmuFileError(f"{path} is no FMU, or a damaged one: {error}") from error
        except KeyError as error:
            raise FmuFileError(f"{path} is no FMU: no modelDescription.xml is in it") from error
        except OSError as error:
            raise FmuFileError(f"{path} cannot be read: {error.strerror or error}") from error
        except Exception as error:  # fmpy raises nothing narrower
            raise FmuFileError(f"{path}: its modelDescription.xml: {one_line(error)}") from error
        if description.fmiVersion == "1.0":
            raise FmuFileError(f"{path} is of FMI 1.0: export it again as FMI 2 or 3")
        folders = {place.parts[1] for place in places if _is_binary(place)}
        sources = any(place.parts[:1] == (SOURCES,) and place.suffix == ".c" for place in places)
        return cls(path, description, tuple(sorted(folders)), sources, invalid)

    @property
    def version(self) -> int:
        """Of FMI: 2 or 3."""
        return int(self.description.fmiMajorVersion)

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """Those that can be used here, the one that is used first."""
        return tuple(self._offered)

    def interface(self) -> Interface:
        """The one that is used. Raises FmuFileError: there is none, it does not say which library
        it is in, or that is not there for this machine."""
        if not self.interfaces:
            raise FmuFileError(f"{self.path} has neither co-simulation nor model exchange")
        if not self._offered[self.interfaces[0]].modelIdentifier:
            raise FmuFileError(
                f"{self.path}: its modelDescription.xml: {self.interfaces[0]} has no "
                "modelIdentifier, the name of its library"
            )
        if self.folder not in self.platforms:
            others = ", ".join(self.platforms) or "none at all"
            compiled = f"; `fmpy compile {self.path.name}` makes one" if self.has_sources else ""
            raise FmuFileError(
                f"{self.path} has no binary for this machine ({self.folder}), but: "
                f"{others}{compiled}"
            )
        return self.interfaces[0]

    @property
    def _offered(self) -> dict[Interface, InterfaceType]:
        there: dict[Interface, InterfaceType | None] = {
            "co-simulation": self.description.coSimulation,
            "model exchange": self.description.modelExchange,
        }
        return {name: offered for name, offered in there.items() if offered is not None}

    @property
    def folder(self) -> str:
        """FMI's name for the folder of this machine's binary. Raises BuildError: none is known."""
        platform = host_platform()
        return platform.fmi2_folder if self.version == 2 else platform.fmi3_folder

    @property
    def variables(self) -> dict[str, ModelVariable]:
        """By name."""
        return {variable.name: variable for variable in self.description.modelVariables}


def _described(path: Path) -> tuple[ModelDescription, str]:
    """The description, and what is wrong with it: many tools write what the schema does not allow
    and everybody can read."""
    try:
        return fmpy.read_model_description(path), ""
    except ValidationError as error:
        return fmpy.read_model_description(path, validate=False), one_line(error.problems[0])


def _is_binary(place: PurePosixPath) -> bool:
    """`binaries/PLATFORM/LIBRARY`."""
    return len(place.parts) == 3 and place.parts[0] == "binaries"


def one_line(error: object) -> str:
    """What an error says; its kind, where it says nothing."""
    return " ".join(str(error).split()) or type(error).__name__
