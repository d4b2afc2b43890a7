"""A run that was overheard, in a telemetry log or a capture: how long each tick's answer took."""

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from laglab.extras import CAPTURES, require
from laglab.link.errors import LinkFileError
from laglab.link.importing.how import NOT_KNOWN_WHICH, How, halves
from laglab.link.measured import Flow, MeasuredLink
from laglab.link.resampling import known_everywhere
from laglab_protocol import Command, Frame, Tick, TlogError, decode, read_tlog


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
    """From each tick's first LAGLAB_TICK to its first LAGLAB_COMMAND, by halves."""
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
    lost = np.isnan(took)
    notes = [halves("From a tick to its answer, the station's thinking included")]
    notes += [NOT_KNOWN_WHICH] if lost.any() else []
    if np.allclose(took[~lost] / interval, np.round(took[~lost] / interval), atol=1e-3):
        notes.append("Its times are whole ticks: nothing finer is known, and within a tick is 0.")
    return MeasuredLink(
        Flow(sent - sent[0], took / 2, how.sizes.command),
        Flow(
            sent - sent[0], known_everywhere(took, np.zeros_like(lost)) / 2, how.sizes.measurement
        ),
        interval,
        tuple(notes),
    )
