"""The dialect file, and what mavgen makes of it."""

import contextlib
import io
import shutil
import tempfile
from argparse import Namespace
from pathlib import Path

from laglab_protocol.dialect.includes import carried_dialects, includes_of
from laglab_protocol.errors import DialectError

__all__ = [
    "GENERATED",
    "LANGUAGES",
    "carried_dialects",
    "dialect_path",
    "generate",
    "generate_into",
    "offer_to_pymavlink",
    "place_in_pymavlink",
]

LANGUAGES = ("C", "C++11", "CS", "Java", "Python3", "Swift", "WLua")
GENERATED = Path(__file__).parent / "generated" / "laglab.py"


def dialect_path() -> Path:
    """The dialect's XML: beside this package in a clone, inside it when installed."""
    package = Path(__file__).parents[1]
    candidates = (package.parent / "laglab.xml", package / "laglab.xml")
    return next(path for path in candidates if path.is_file())


def offer_to_pymavlink() -> None:
    """Let pymavlink's tools of this process find the dialect by name, as `--dialect laglab`.

    They want MAVLINK20=1 in the environment before they are imported.
    """
    import pymavlink.dialects.v20 as dialects

    dialects.__path__.append(str(GENERATED.parent))


def place_in_pymavlink() -> Path:
    """Where pymavlink's tools look for the dialect that is asked for as `--dialect laglab`."""
    return carried_dialects() / GENERATED.name


def generate(xml: Path, language: str, output: Path) -> None:
    """Run mavgen (MAVLink 2) on `xml`, which may include the dialects that pymavlink carries.

    `language` is one of mavgen's names: C, Python3, WLua, … `output` is a file for Python3
    and WLua, a folder for the others. mavgen evaluates enum values, so `xml` must be the caller's
    own.
    Raises DialectError with mavgen's words when it refuses, and OSError.
    """
    from pymavlink.generator import mavgen

    options = Namespace(
        language=language,
        wire_protocol="2.0",
        output=str(output),
        validate=True,
        strict_units=False,
        error_limit=200,
    )
    with tempfile.TemporaryDirectory() as folder:
        source = _beside_its_includes(xml, Path(folder))
        said = io.StringIO()
        try:
            with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
                done = mavgen.mavgen(options, [str(source)])
        except OSError as error:
            raise OSError(error.errno, error.strerror, str(output)) from error
        except (SystemExit, Exception) as error:
            raise DialectError(f"{xml}: mavgen fails: {error}\n{said.getvalue()}") from error
    if done is False:
        raise DialectError(f"{xml}: mavgen refuses it:\n{said.getvalue()}")
    if language == "WLua":
        _mend_dissector(output)


def generate_into(language: str, directory: Path, xml: Path | None = None) -> Path:
    """Generate our dialect, or another, in one of LANGUAGES; returns the file or folder.

    WLua is the dissector for Wireshark: `wireshark -X lua_script:laglab.lua`. Raises DialectError.
    """
    if language not in LANGUAGES:
        raise DialectError(f"no language {language!r}: take one of {', '.join(LANGUAGES)}")
    xml = xml or dialect_path()
    if not xml.is_file():
        raise DialectError(f"cannot read {xml}: no such file")
    directory.mkdir(parents=True, exist_ok=True)
    suffix = {"Python3": ".py", "WLua": ".lua"}.get(language)
    output = directory / f"{xml.stem}{suffix}" if suffix else directory
    generate(xml, language, output)
    return output


def _mend_dissector(output: Path) -> None:
    """mavgen calls a method that Wireshark lacks; its le_float reads eight bytes too."""
    output.write_text(output.read_text().replace(":le_double()", ":le_float()"))


def _beside_its_includes(xml: Path, folder: Path) -> Path:
    """Copy `xml` into `folder` with the dialects that it includes: mavgen looks for them there.

    Raises DialectError: one of them is nowhere.
    """
    includes = includes_of(xml)
    if includes.missing:
        raise DialectError(
            f"{xml} includes {includes.missing[0]!r}, which is neither beside it nor pymavlink's"
        )
    for path in includes.found.values():
        shutil.copy(path, folder)
    return Path(shutil.copy(xml, folder / xml.name))
