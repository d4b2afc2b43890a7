"""What `ping` prints, on Linux, BSD, macOS, BusyBox and Windows."""

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
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
LATE = 4096
"""Numbers: an answer is at most so far behind others."""


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
    told = list(_told(lines, name))
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


def _told(lines: list[str], name: str) -> Iterator[_Numbered]:
    """Raises LinkFileError: which of them came first is not clear."""
    printed = list(_printed(lines))
    pace = _pace(printed)
    lowest = 0 if _begins(lines) else -WRAP
    last = None
    for each in printed:
        if last is not None:
            step = _step(last.number, each.number, _elapsed(last, each, pace), lowest)
            if step is None:
                raise LinkFileError(
                    f"{name}: {last.number % WRAP} is followed by {each.number}: give one ping's "
                    "output at a time; after a long outage only the times of ping -D tell"
                )
            each = each._replace(number=last.number + step)
        yield each
        last = each


def _printed(lines: list[str]) -> Iterator[_Numbered]:
    """With the numbers that travelled."""
    for line in lines:
        if found := NUMBER.search(line):
            time, at = TIME.search(line, found.end()), AT.match(line)
            took = 1e-3 * float(time[1]) if time else np.nan
            yield _Numbered(int(found[1]), took, float(at[1]) if at else None)


def _elapsed(last: _Numbered, then: _Numbered, pace: float | None) -> float | None:
    """[pings] None: no times tell."""
    if pace is None or last.at is None or then.at is None:
        return None
    return (then.at - last.at) / pace


def _step(last: int, number: int, elapsed: float | None, lowest: int) -> int | None:
    """From the last one to this, which travelled as `number`, `elapsed` [pings] later if that is
    known; None: nobody knows. None is below `lowest`. What is a little further on is that: whose
    ping was stopped meanwhile has no numbers for that time."""
    on = (number - last) % WRAP
    if on <= LATE:
        return on
    if elapsed is not None:
        return on + WRAP * max(-1, round((elapsed - on) / WRAP))
    if WRAP - on <= LATE and last + on - WRAP >= lowest:
        return on - WRAP
    return on if number > last % WRAP or on < WRAP // 2 else None


def _begins(lines: list[str]) -> bool:
    return any(map(HEADING.match, lines))


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
    if (first <= 1 or _begins(lines)) and last <= sent:
        first = min(first, 1)
        last = max(last, first + sent - 1)
    return first, last


def _in_order(lines: list[str]) -> Array:
    """Windows prints no numbers, but a line for each."""
    found = [each for line in lines if (each := WINDOWS.match(line))]
    return np.array([1e-3 * float(each["ms"] or "nan") for each in found])


def _interval(told: list[_Numbered], lines: list[str], count: int) -> tuple[float, bool]:
    """[s] From ping to ping, and whether the output tells."""
    if pace := _pace([each for each in told if not np.isnan(each.took)]):
        return pace, True
    ends = (TOOK.search(line) for line in lines if SENT.match(line))
    if count > 1 and (took := next((found for found in ends if found), None)):
        return 1e-3 * int(took[1]) / (count - 1), True
    return USUAL, False


def _pace(told: Sequence[_Numbered]) -> float | None:
    """[s] From ping to ping, by the times of those that follow each other closely."""
    paces = [
        (then.at - last.at) / on
        for last, then in pairwise(told)
        if last.at is not None and then.at is not None
        if 0 < (on := (then.number - last.number) % WRAP) <= LATE
    ]
    pace = float(np.median(paces)) if paces else 0.0
    return pace if pace > 0 else None
