"""The gateway's loop on the wall clock: ticks happen when they are due, answered or not.

The deadline of tick k is start + k Ts / speed, never a sum of sleeps, so lateness does not add up.
What has arrived by a deadline counts; the link's own delay adds to n and m, and the stamps tell.
"""

from collections.abc import Callable
from time import monotonic
from typing import Any

import numpy as np

from laglab_gateway.core import Gateway
from laglab_gateway.loops.conversation import Conversation, Link, Patience
from laglab_gateway.loops.watch import Watch
from laglab_gateway.record.recorder import Recorder, TimingRow
from laglab_gateway.side import Outcome
from laglab_protocol import EndReason


class Lateness:
    """How late each tick began [s], and how many began after the next one was due."""

    def __init__(self, period: float) -> None:
        self._period = period
        self._seconds: list[float] = []
        self._missed = 0

    def add(self, seconds: float) -> bool:
        """One more tick; True when it is the first that missed its deadline."""
        self._seconds.append(seconds)
        first = seconds > self._period and not self._missed
        self._missed += seconds > self._period
        return first

    def report(self) -> dict[str, Any]:
        """For the summary; a deadline is missed when the tick began a whole period late."""
        late = np.array(self._seconds or [np.nan])
        p50, p99 = np.percentile(late, (50, 99))
        return {
            "p50_s": float(p50),
            "p99_s": float(p99),
            "max_s": float(late.max()),
            "missed_deadlines": self._missed,
        }


def serve_realtime(
    gateway: Gateway,
    endpoint: Link,
    recorder: Recorder,
    patience: Patience,
    progress: Callable[[int], None],
    period: float,
    now: Callable[[], float] = monotonic,
    watch: Watch | None = None,
) -> tuple[Outcome, Lateness]:
    """Run a gateway to its last tick, one tick every `period` [s] of the clock `now`.
    Those who `watch` are looked after meanwhile.

    Between a deadline and the tick's first byte nothing is done that can be done at another time:
    the plant has been stepped, files wait. `progress` is told of each tick that begins.

    Raises:
        StationSilentError: the station never came, or fell silent for longer than allowed.
        EndpointError: the link itself broke.
    """
    conversation = Conversation(gateway, endpoint, recorder, patience, now, watch)
    lateness = Lateness(period)
    try:
        conversation.wait_for_station()
        start = now()
        while gateway.outcome is None:
            deadline = start + gateway.tick * period
            late = now() - deadline
            if lateness.add(late):
                gateway.announce(f"cannot keep up: tick {gateway.tick} is {late:.3f} s late")
            conversation.send(gateway.open_tick())
            gateway.settle()
            conversation.catch_up()
            conversation.ask_time()
            progress(gateway.tick)
            conversation.check_silence()
            answered = _listen_until(deadline + period, gateway, conversation)
            answer = None if answered is None else answered - deadline - late
            recorder.timing(TimingRow(gateway.tick, late, answer))
            conversation.finish_tick()
    except KeyboardInterrupt:
        gateway.outcome = Outcome(EndReason.INTERRUPTED, gateway.tick)
    conversation.say_goodbye(gateway.outcome)
    return gateway.outcome, lateness


def _listen_until(deadline: float, gateway: Gateway, conversation: Conversation) -> float | None:
    """Take what arrives before the deadline; when this tick's answer came, if it did."""
    answered = None
    while (left := deadline - conversation.now()) > 0:
        conversation.listen(left)
        if answered is None and gateway.answered:
            answered = conversation.now()
    return answered
