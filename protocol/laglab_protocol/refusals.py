"""Why frames are not taken because of their signatures, for people, and what to do about it."""

from collections.abc import Iterable, Iterator

from laglab_protocol.framing.frame import Refusal
from laglab_protocol.listener import Listener

PERIOD = 1.0
"""[s] So often we look."""
OVERTAKEN = 5
"""So many frames that came out of order are not yet replayed."""

MENDED = {
    Refusal.UNSIGNED: "not signed: give the sender the same {key}",
    Refusal.BAD_SIGNATURE: "not signed with this key: give both sides the same {key}",
    Refusal.NO_KEY: "signed, and there is no key here to tell by whom: give {key} here too",
    Refusal.REPLAYED: "signed no later than what was said before, or over a minute ago: set the "
    "clock there, and let no two senders share a link id",
    Refusal.AHEAD: "signed over a minute ahead of the clock here: set the clocks of both "
    "machines; where they are right now, make a new key",
}
"""By reason: about keys and clocks, which people can mend. `key` is the option's name."""


class Refusals:
    """Says of each link and reason, once, that frames are refused, and how to mend it."""

    def __init__(self, now: float, option: str = "--key") -> None:
        """At `now` [s] there is nothing to be told yet; `option` is where our key is given."""
        self._option = option
        self._told: set[tuple[str, Refusal]] = set()
        self._next = now + PERIOD

    def are_due(self, now: float) -> bool:
        """Whether it is time to look."""
        return now >= self._next

    def news(self, listeners: Iterable[Listener], now: float) -> Iterator[str]:
        """What is to be told since the last time, in a line each, if it is time to look."""
        if not self.are_due(now):
            return
        self._next = now + PERIOD
        for listener in listeners:
            for reason, count in listener.refused.items():
                told = listener.link.name, reason
                enough = OVERTAKEN if reason is Refusal.REPLAYED else 1
                if count >= enough and reason in MENDED and told not in self._told:
                    self._told.add(told)
                    mended = MENDED[reason].format(key=self._option)
                    frames = "1 frame" if count == 1 else f"{count} frames"
                    yield f"{listener.link.name}: {frames} refused: {mended}"
