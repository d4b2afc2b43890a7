"""A dialect's XML, and the files that it includes."""

from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from laglab_protocol.errors import DialectError


class Includes(NamedTuple):
    """All that a dialect includes, and what that includes in turn."""

    found: dict[str, Path]
    missing: list[str]


def carried_dialects() -> Path:
    """The folder of the dialects that pymavlink carries: common.xml and others."""
    import pymavlink.dialects.v20 as dialects

    return Path(dialects.__path__[0])


def parsed(xml: Path) -> Element:
    """Raises DialectError: it cannot be read, or is no XML."""
    try:
        return ElementTree.fromstring(xml.read_bytes())
    except OSError as error:
        raise DialectError(f"cannot read {xml}: {error.strerror}") from error
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise DialectError(f"{xml} is no XML: {error}") from error


def includes_of(xml: Path) -> Includes:
    """Each is looked for beside `xml`, then in pymavlink. Raises DialectError."""
    found: dict[str, Path] = {}
    missing: list[str] = []
    waiting = _named(parsed(xml))
    while waiting:
        name = waiting.pop()
        places = xml.parent / name, carried_dialects() / name
        path = next((place for place in places if place.is_file()), None)
        if path is None:
            missing.append(name)
        elif name not in found:
            found[name] = path
            waiting += _named(parsed(path))
    return Includes(found, missing)


def _named(root: Element) -> list[str]:
    """Plain file names only: an include does not lead out of its folder."""
    return [Path(each.text or "?").name or "?" for each in root.findall("include")]
