"""A run that was overheard, in a telemetry log or a capture: how long each tick's answer took."""

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from laglab.extras import CAPTURES, require
from laglab.link.errors import LinkFileError
from laglab.link.importing.how import How, by_halves, halves
from laglab.link.measured import MeasuredLink
from laglab_protocol import Command, Frame, Tick, TlogError, decode, read_tlog

COARSE = (
    "Its times are whole ticks: nothing finer is known, and within a tick is 0. Of a simulated "
    "link it holds nothing: that is in the run's link.csv."
)


class Heard(NamedTuple):
    """A frame, and when it was overheard [s]."""

    time: float
    frame: Frame


def read_log(path: Path, how: How) -> MeasuredLink:
    """A robot.tlog. Raises LinkFileError."""
    try:
        heard = [Heard(time_us * 1e-6, frame) for time_us, frame in read_tlog(path)]
    except TlogError as error:
        raise LinkFileError(str(error)) from error
    return answers(heard, how, str(path))


def read_capture(path: Path, how: How) -> MeasuredLink:
    """A pcap or pcapng. Raises LinkFileError, MissingExtraError."""
    require(CAPTURES)
    from laglab.link.importing.captures import datagrams

    heard = [
        Heard(time, frame) for time, payload in datagrams(path) for frame in _frames_of(payload)
    ]
    return answers(heard, how, str(path))


def _frames_of(payload: bytes) -> Iterable[Frame]:
    """Signed or not: what was overheard need not be believed."""
    place = 0
    while place < len(payload):
        found = decode(payload, place)
        if isinstance(found, Frame):
            yield found
            place += len(found.raw)
        else:
            place += 1


def answers(heard: Iterable[Heard], how: How, name: str) -> MeasuredLink:
    """Halves of the times from each tick's first LAGLAB_TICK to its first LAGLAB_COMMAND.

    Raises LinkFileError: no run is in it, or its ticks all have one time.
    """
    asked: dict[int, float] = {}
    answered: dict[int, float] = {}
    for time, frame in heard:
        match frame.message:
            case Tick(tick=tick):
                asked.setdefault(tick, time)
            case Command(tick=tick):
                answered.setdefault(tick, time)
    ticks = sorted(asked)
    if len(ticks) < 2 or not answered:
        raise LinkFileError(f"{name}: no run in it: no ticks that were answered")
    last = max((tick for tick in ticks if tick in answered), default=ticks[-1])
    ticks = [tick for tick in ticks if tick <= last]  # at the end the station was gone
    sent = np.array([asked[tick] for tick in ticks])
    took = np.array([answered.get(tick, np.nan) for tick in ticks]) - sent
    took[took < 0] = np.nan
    interval = float(np.median(np.diff(sent) / np.diff(ticks))) if len(ticks) > 1 else 0.0
    if interval <= 0:
        raise LinkFileError(f"{name}: its ticks have all the same time")
    ticks_taken = took[~np.isnan(took)] / interval
    coarse = np.allclose(ticks_taken, np.round(ticks_taken), atol=1e-3)
    note = halves("From a tick to its answer, the station's thinking included")
    return by_halves(sent - sent[0], took, interval, how, note, *([COARSE] if coarse else []))
