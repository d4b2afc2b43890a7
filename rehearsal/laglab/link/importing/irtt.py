"""What `irtt client -o` writes: a probe every interval, with clocks at both ends."""

import json
import math
from collections.abc import Mapping, Sequence
from typing import cast

import numpy as np

from laglab.link.errors import LinkFileError
from laglab.link.importing.how import NOT_KNOWN_WHICH, How, halves
from laglab.link.measured import Array, Flow, MeasuredLink
from laglab.link.probing import seen_by_clocks
from laglab.link.probing.clocks import ClockTimes
from laglab.link.resampling import known_everywhere

UP, DOWN, EITHER = "true_up", "true_down", "true"
Json = Mapping[str, object]


def read_irtt(text: bytes, how: How, name: str) -> MeasuredLink:
    """One-way delays where the server stamped its times, else halves. Raises LinkFileError."""
    try:
        whole = json.loads(text)
        trips: Sequence[Json] = whole["round_trips"]
        sent = np.array(
            [_number(each, "timestamps", "client", "send", "monotonic") for each in trips]
        )
        lost = np.array([str(each["lost"]) for each in trips])
        there, back, trip = (
            np.array([_number(each, "delay", key) for each in trips]) * 1e-9
            for key in ("send", "receive", "rtt")
        )
    except (
        ValueError,
        KeyError,
        TypeError,
        AttributeError,
        OverflowError,
        RecursionError,
    ) as error:
        raise LinkFileError(f"{name}: JSON, but not as irtt writes it: {error}") from error
    if not len(trips):
        raise LinkFileError(f"{name}: irtt sent nothing")
    return _measured((sent - sent[0]) * 1e-9, lost, (there, back, trip), how)


def _measured(
    sent: Array, lost: Array, delays: tuple[Array, Array, Array], how: How
) -> MeasuredLink:
    there, back, trip = delays
    up, down = np.isin(lost, (UP, EITHER)), lost == DOWN
    if np.isnan(there).all() or np.isnan(back).all():
        ours, theirs, note = trip / 2, trip / 2, halves("irtt, without the server's times")
    else:
        ours, theirs, note = seen_by_clocks(
            ClockTimes(sent, there), ClockTimes(sent, back), how.within
        )
    interval = float(np.median(np.diff(sent))) if len(sent) > 1 else how.interval or math.inf
    return MeasuredLink(
        Flow(sent, known_everywhere(ours, up), how.sizes.command),
        Flow(sent, known_everywhere(theirs, down), how.sizes.measurement),
        interval,
        (note, *([NOT_KNOWN_WHICH] if (lost == EITHER).any() else [])),
    )


def _number(trip: Json, *path: str) -> float:
    """NaN where there is none."""
    value: object = trip
    for key in path:
        value = cast("Json", value).get(key) if isinstance(value, Mapping) else None
    return math.nan if value is None else float(cast("float", value))
