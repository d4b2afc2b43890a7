"""Those who speak to the services, each from one place."""

from collections import OrderedDict

from laglab_gateway.services.pace import Pace
from laglab_protocol import (
    Address,
    CommandInt,
    CommandLong,
    Frame,
    Message,
    ParamSet,
    Ration,
)

ANSWERS_AT_ONCE = 64
"""A ground station that starts asks for all parameters, and for some more."""
ANSWERS_A_SECOND = 64.0

MOST_ASKERS = 16
FORGOTTEN = 10.0
"""[s] Who was silent for so long makes room for others."""
GONE = 60.0
"""[s] Who was silent for so long is told nothing more: a ground station calls every second."""

CHANGES = (CommandLong, CommandInt, ParamSet)
"""All else asks and changes nothing: it is passed over when no answer is left."""


class Asker:
    """One who speaks: how much more it may be told now, and how often what it watches is sent."""

    def __init__(self, ration: Ration | None = None, pace: Pace | None = None) -> None:
        """Without a ration it may be told everything; those who are sent telemetry have a pace."""
        self._ration = ration
        self.pace = pace
        self.heard = float("-inf")

    def listen(self, now: float) -> None:
        """It is heard again, at `now` [s]."""
        self.heard = now
        if self._ration:
            self._ration.left(now)

    @property
    def room(self) -> float:
        """Answers that it may have now."""
        return max(self._ration.rest, 0.0) if self._ration else float("inf")

    def is_worth_asking(self, frame: Frame) -> bool:
        """Whether to look at what it says at all."""
        return self.room >= 1 or isinstance(frame.message, CHANGES)

    def granted(self, answers: list[Message]) -> list[Message]:
        """As many of them as it may have."""
        granted = answers if self.room >= len(answers) else answers[: int(self.room)]
        if self._ration:
            self._ration.take(len(granted))
        return granted


def _rationed(pace: Pace | None) -> Asker:
    return Asker(Ration(ANSWERS_A_SECOND, ANSWERS_AT_ONCE), pace)


class Askers:
    """Those of one link, by their addresses; beyond so many, all others count as one."""

    def __init__(self, watching: bool = False) -> None:
        """`watching`: they are sent telemetry."""
        self._watching = watching
        self._known: OrderedDict[Address | None, Asker] = OrderedDict()
        self._crowd = _rationed(None)

    def heard_from(self, address: Address | None, now: float) -> Asker:
        """Who speaks from there, at `now` [s]."""
        asker = self._known.get(address) or self._new(address, now)
        asker.listen(now)
        if address in self._known:
            self._known.move_to_end(address)
        return asker

    def _new(self, address: Address | None, now: float) -> Asker:
        if len(self._known) >= MOST_ASKERS:
            oldest, asker = next(iter(self._known.items()))
            if now - asker.heard < FORGOTTEN:
                return self._crowd
            del self._known[oldest]
        asker = self._known[address] = _rationed(Pace() if self._watching else None)
        return asker

    def forget(self, address: Address | None) -> None:
        """Nothing reaches it."""
        self._known.pop(address, None)

    def forget_silent(self, now: float) -> None:
        """Those who were not heard for long, at `now` [s]; the one far end of a link stays."""
        for address, asker in self.known():
            if address is not None and now - asker.heard > GONE:
                self.forget(address)

    def known(self) -> list[tuple[Address | None, Asker]]:
        """All but the crowd."""
        return list(self._known.items())
