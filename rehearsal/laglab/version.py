"""Which laglab this is."""

import hashlib
import platform
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from importlib.resources import files
from importlib.resources.abc import Traversable
from zipfile import ZipFile

PACKAGES = (
    "laglab",
    "laglab_control",
    "laglab_fmu",
    "laglab_gateway",
    "laglab_protocol",
    "laglab_station",
)
"""The packages that a run goes through."""


@cache
def laglab_version() -> str:
    """As installed; looked up once, for each look-up leaves something in memory."""
    return version("laglab")


@cache
def versions() -> dict[str, str]:
    """Of Python, and of what a run computes with, as far as it is installed."""
    found = {"Python": platform.python_version()}
    for name in ("numpy", "FMPy"):
        with suppress(PackageNotFoundError):
            found[name] = version(name)
    return found


@cache
def code_version() -> str:
    """The same, and a digest of the sources: other code has another one, whatever it calls itself.

    Of an FMU its sources count, not its binaries, so that machines of several kinds agree.
    """
    digest = hashlib.sha256()
    for package in PACKAGES:
        for name, content in _sources(files(package), package):
            digest.update(f"{name}\0{hashlib.sha256(content).hexdigest()}\n".encode())
    return f"{laglab_version()}+{digest.hexdigest()[:16]}"


def _sources(folder: Traversable, place: str) -> Iterator[tuple[str, bytes]]:
    for entry in sorted(folder.iterdir(), key=lambda entry: entry.name):
        name = f"{place}/{entry.name}"
        if entry.is_dir():
            yield from _sources(entry, name)
        elif entry.name.endswith(".py"):
            yield name, entry.read_bytes()
        elif entry.name.endswith(".fmu"):
            yield from _of_fmu(entry, name)


def _of_fmu(fmu: Traversable, name: str) -> Iterator[tuple[str, bytes]]:
    with fmu.open("rb") as file, ZipFile(file) as inside:
        for info in inside.infolist():
            if info.filename.startswith("sources/"):
                yield f"{name}/{info.filename}", info.CRC.to_bytes(4, "big")
