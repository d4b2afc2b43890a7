"""What `ping` prints, on Linux, BSD, macOS, BusyBox and Windows."""

import re

import numpy as np

from laglab.link.importing.how import NOT_KNOWN_WHICH, How, halves
from laglab.link.measured import Array, Flow, MeasuredLink
from laglab.link.resampling import known_everywhere

ANSWER = re.compile(
    r"^(?:\[(?P<at>\d+\.\d+)\] )?.*\b(?:icmp_)?seq[= ](?P<number>\d+)\b.*"
    r"\btime[=<](?P<ms>\d+(?:\.\d+)?) ?ms",
    re.MULTILINE,
)
WINDOWS = re.compile(r"^Reply from .*time[=<](?P<ms>\d+)ms|^Request timed out", re.MULTILINE)
SENT = re.compile(r"^(\d+) packets transmitted", re.MULTILINE)
TOOK = re.compile(r"\btime (\d+) ?ms", re.MULTILINE)
USUAL = 1.0
"""[s] From ping to ping, where nothing says otherwise."""
WRAP = 65536
"""Of the numbers that travel."""


def is_ping(text: str) -> bool:
    """Whether there are any answers in it."""
    return bool(
        ANSWER.search(text) or re.search(r"^Reply from .*time[=<]\d+ms", text, re.MULTILINE)
    )


def read_ping(text: str, how: How) -> MeasuredLink:
    """Halves of round trips."""
    numbered = _answers(text)
    took = _numbered(numbered, text) if numbered else _in_order(text)
    lost = np.isnan(took)
    interval, told = _interval(text, len(took))
    sent = interval * np.arange(len(took), dtype=np.float64)
    note = halves("ping") + ("" if told else " It is taken to have pinged once a second.")
    return MeasuredLink(
        Flow(sent, took / 2, how.sizes.command),
        Flow(sent, known_everywhere(took, np.zeros_like(lost)) / 2, how.sizes.measurement),
        interval,
        (note, *([NOT_KNOWN_WHICH] if lost.any() else [])),
    )


def _answers(text: str) -> dict[int, float]:
    """By number, which goes on where it wraps: the round trip [s]."""
    answers: dict[int, float] = {}
    last = 0
    for found in ANSWER.finditer(text):
        number = int(found["number"])
        number += round((last - number) / WRAP) * WRAP
        last = number
        answers.setdefault(number, 1e-3 * float(found["ms"]))
    return answers


def _numbered(answers: dict[int, float], text: str) -> Array:
    first = 0 if 0 in answers else 1
    sent = SENT.search(text)
    count = max(answers) - first + 1
    count = max(count, int(sent[1])) if sent else count
    return np.array([answers.get(first + i, np.nan) for i in range(count)])


def _in_order(text: str) -> Array:
    """Windows prints no numbers, but a line for each."""
    return np.array([1e-3 * float(each["ms"] or "nan") for each in WINDOWS.finditer(text)])


def _interval(text: str, count: int) -> tuple[float, bool]:
    """[s] From ping to ping, and whether the output tells."""
    times = [float(found["at"]) for found in ANSWER.finditer(text) if found["at"]]
    if len(times) > 1:
        return float(np.median(np.diff(times))), True
    took = TOOK.search(text, text.rfind("packets transmitted"))
    if took and count > 1:
        return 1e-3 * int(took[1]) / (count - 1), True
    return USUAL, False
