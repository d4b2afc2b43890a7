"""What strangers' things say of themselves, in a line."""

import sys
import traceback
from pathlib import Path
from typing import NamedTuple

SHOWN, LONGEST = 60, 400
"""[characters] At most so much of a wrong answer, and of an exception's text, is shown."""

OURS = {
    *("laglab", "laglab_control", "laglab_station", "laglab_gateway"),
    *("laglab_protocol", "laglab_fmu", "laglab_conformance"),
}
NOT_THEIRS = {*OURS, "numpy", *sys.stdlib_module_names}
"""Top-level modules in which no stranger errs, though what a stranger gave them may fail there."""


def one_line(error: BaseException) -> str:
    """Kind and text, as far as it can be told."""
    try:
        text = str(error)
    except Exception:  # a stranger's, too
        text = ""
    kind = type(error).__name__
    return in_one_line(f"{kind}: {text}" if text else kind)


def in_one_line(text: str) -> str:
    """A stranger's, as far as it can be told."""
    return _short(text, LONGEST)


class _Place(NamedTuple):
    module: str
    file: str
    line: int

    @property
    def is_theirs(self) -> bool:
        """What a dataclass or a tuple has made for itself is in no file."""
        return self.module.partition(".")[0] not in NOT_THEIRS and self.file != "<string>"

    @property
    def is_installed(self) -> bool:
        return not {"site-packages", "dist-packages"}.isdisjoint(Path(self.file).parts)


def failure(error: BaseException) -> str:
    """The same of what was raised in a stranger's code, and where in the stranger's own file."""
    called = [
        _Place(str(frame.f_globals.get("__name__")), frame.f_code.co_filename, line)
        for frame, line in traceback.walk_tb(error.__traceback__)
    ][1:]
    if not called:
        return one_line(error)
    theirs = [place for place in called if place.is_theirs]
    own = [place for place in theirs if not place.is_installed]  # not in a library of theirs
    innermost = (own or theirs or called[:1])[-1]
    return f"{one_line(error)} ({Path(innermost.file).name}, line {innermost.line})"


def shown(answer: object) -> str:
    """What was answered, in a line."""
    try:
        text = repr(answer)
    except Exception:
        text = f"an object of {type(answer).__name__}"
    return _short(text, SHOWN)


def _short(text: str, longest: int) -> str:
    """In one line, without what would control a terminal."""
    line = " ".join("".join(each if each.isprintable() else " " for each in text).split())
    return line if len(line) <= longest else f"{line[:longest]}..."


def first_line(made_by: object) -> str:
    """Of the docstring; nothing where there is none."""
    lines = (getattr(made_by, "__doc__", None) or "").strip().splitlines()
    return lines[0] if lines else ""
