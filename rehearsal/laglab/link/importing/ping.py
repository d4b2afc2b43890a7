"""What `ping` prints, on Linux, BSD, macOS, BusyBox and Windows."""

import re
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from laglab.link.errors import LinkFileError
from laglab.link.importing.how import How, by_halves, halves
from laglab.link.measured import Array, MeasuredLink
from laglab_gateway import MOST_TICKS

LONGEST_LINE = 400
"""[characters] No ping prints a longer line; the time to search one grows as its square."""
NUMBER = re.compile(r"\b(?:icmp_)?seq[= ](\d{1,10})\b")
AT = re.compile(r"^\[(\d{1,12}\.\d+)\] ")
TIME = re.compile(r"\btime[=<](\d{1,9}(?:\.\d+)?) ?ms")
WINDOWS = re.compile(r"^Reply from .*time[=<](?P<ms>\d{1,9})ms|^Request timed out")
HEADING = re.compile(r"^PING6?[ (]")
SENT = re.compile(r"^(\d{1,15}) packets transmitted")
TOOK = re.compile(r"\btime (\d{1,15}) ?ms")
USUAL = 1.0
"""[s] From ping to ping, where nothing says otherwise."""
WRAP = 65536
"""A ping's number travels in 16 bits."""


class _Numbered(NamedTuple):
    """A line about one ping: its number, which goes on where the one that travels wraps."""

    number: int
    took: float
    """[s] NaN: it says that no answer came."""
    at: float | None
    """[s] When it was printed."""


def is_ping(text: str) -> bool:
    """Whether it tells of an answer, or that none came."""
    return any(
        SENT.match(line) or WINDOWS.match(line) or NUMBER.search(line) for line in _lines(text)
    )


def read_ping(text: str, how: How, name: str) -> MeasuredLink:
    """Halves of round trips. Raises LinkFileError: nothing came back, or too much did."""
    lines = _lines(text)
    if (count := _outputs(lines)) > 1:
        raise LinkFileError(f"{name}: {count} outputs of ping in one file: give one at a time")
    told = list(_told(lines))
    took = _by_number(told, lines, name) if told else _in_order(lines)
    if np.isnan(took).all():
        raise LinkFileError(
            f"{name}: ping had no answer at all: nothing is known of the link but that it was down"
        )
    interval, known = _interval(told, lines, len(took))
    sent = interval * np.arange(len(took), dtype=np.float64)
    note = halves("ping") + ("" if known else " It is taken to have pinged once a second.")
    return by_halves(sent, took, interval, how, note)


def _lines(text: str) -> list[str]:
    return [line for line in text.splitlines() if len(line) <= LONGEST_LINE]


def _outputs(lines: list[str]) -> int:
    """How many pings printed this: each begins with a heading and ends with what it has sent, but
    of the first and the last there may be a part."""
    count, going_on = 0, False
    for line in lines:
        heading, sent = HEADING.match(line), SENT.match(line)
        count += bool(heading or (not going_on and (sent or NUMBER.search(line))))
        going_on = not sent and bool(going_on or heading or NUMBER.search(line))
    return count


def _told(lines: list[str]) -> Iterator[_Numbered]:
    last = None
    for line in lines:
        if (found := NUMBER.search(line)) is None:
            continue
        number = int(found[1])
        if last is not None:
            number += round((last - number) / WRAP) * WRAP
        last = number
        time, at = TIME.search(line, found.end()), AT.match(line)
        took = 1e-3 * float(time[1]) if time else np.nan
        yield _Numbered(number, took, float(at[1]) if at else None)


def _by_number(told: list[_Numbered], lines: list[str], name: str) -> Array:
    """From the first to the last that was sent, as far as this part of the output tells."""
    first, last = _range(told, lines)
    if (count := last - first + 1) > MOST_TICKS:
        raise LinkFileError(f"{name}: {count} pings, {MOST_TICKS} at most: give a part of it")
    took = np.full(count, np.nan)
    for each in reversed(told):  # of doubles the first counts
        if not np.isnan(each.took):
            took[each.number - first] = each.took
    return took


def _range(told: list[_Numbered], lines: list[str]) -> tuple[int, int]:
    """The first and the last number: of those told of; in a whole output, of all that were sent."""
    first = min(each.number for each in told)
    last = max(each.number for each in told)
    sent = next((int(found[1]) for line in lines if (found := SENT.match(line))), 0)
    begins = first <= 1 or any(map(HEADING.match, lines))
    if begins and last <= sent:
        first = min(first, 1)
        last = max(last, first + sent - 1)
    return first, last


def _in_order(lines: list[str]) -> Array:
    """Windows prints no numbers, but a line for each."""
    found = [each for line in lines if (each := WINDOWS.match(line))]
    return np.array([1e-3 * float(each["ms"] or "nan") for each in found])


def _interval(told: list[_Numbered], lines: list[str], count: int) -> tuple[float, bool]:
    """[s] From ping to ping, and whether the output tells."""
    times = [each.at for each in told if each.at is not None and not np.isnan(each.took)]
    if len(times) > 1:
        return float(np.median(np.diff(times))), True
    ends = (TOOK.search(line) for line in lines if SENT.match(line))
    if count > 1 and (took := next((found for found in ends if found), None)):
        return 1e-3 * int(took[1]) / (count - 1), True
    return USUAL, False
