"""What strangers' things say of themselves, in a line."""

import traceback
from pathlib import Path

SHOWN, LONGEST = 60, 400
"""[characters] At most so much of a wrong answer, and of an exception's text, is shown."""


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


def failure(error: BaseException) -> str:
    """The same of what was raised in a stranger's code, and where in the file that was called."""
    frames = traceback.walk_tb(error.__traceback__)
    theirs = [(frame.f_code.co_filename, line) for frame, line in frames][1:]
    if not theirs:
        return one_line(error)
    file, _ = theirs[0]
    line = [line for name, line in theirs if name == file][-1]
    return f"{one_line(error)} ({Path(file).name}, line {line})"


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
