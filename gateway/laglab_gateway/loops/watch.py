"""Those who look on: ground stations on links of their own, apart from the loop's."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from time import monotonic_ns
from weakref import WeakKeyDictionary

from laglab_gateway.loops.datagrams import datagrams
from laglab_gateway.services import Asker, Askers, RobotState, Services
from laglab_protocol import (
    LEAST_BYTES,
    Address,
    EndpointError,
    Frame,
    Listener,
    Message,
    Ration,
    Sender,
)

POLL_US = 5_000
"""[us] Between two looks at the watchers; in between they do not hold up the loop."""

HEARD_A_SECOND, HEARD_AT_ONCE = 32768, 2048
"""Bytes that are read from one link; what comes beyond has to wait."""


class Watcher:
    """One link, and who makes the frames on it. Of several who watch there, each is served apart.

    Unless it is `trusting`, who signs nothing may only see, arm and stop.
    """

    def __init__(self, listener: Listener, sender: Sender, trusting: bool = True) -> None:
        self.listener = listener
        self.askers = Askers(watching=True)
        self.askers.heard_from(None, 0.0)  # where there is one far end, it need not ask
        self.ration = Ration(HEARD_A_SECOND, HEARD_AT_ONCE, LEAST_BYTES)
        self._trusting = trusting
        self._sender = sender
        self._senders = WeakKeyDictionary[Asker, Sender]()

    def trusts(self, frame: Frame) -> bool:
        """Whether who sent it may do everything."""
        return self._trusting or frame.signed

    def say(self, messages: Sequence[Message], asker: Asker, to: Address | None) -> None:
        """To one of them; what there is no room for is not said."""
        sender = self._senders.setdefault(asker, self._sender.sibling())
        frames = [sender.frame(message) for message in messages]
        for datagram in datagrams(frames):
            self.listener.link.offer(datagram, to)


class Watch:
    """Answers the watchers' requests, and sends them telemetry.

    LAGLAB_COMMAND counts on the loop's own link alone, so they may stop the robot, not drive it.
    A watcher whose link breaks, or who stops reading, is let go: the loop is not held up for it.
    """

    def __init__(self, services: Services, watchers: list[Watcher]) -> None:
        self._services = services
        self._watchers = watchers
        self._lost: list[str] = []
        self._next_us = 0

    def poll(self, state: Callable[[], RobotState]) -> None:
        """Look after them, if it is time; costs next to nothing when it is not."""
        now_us = monotonic_ns() // 1000
        if now_us < self._next_us or not self._watchers:
            return
        self._next_us = now_us + POLL_US
        now = state()
        for watcher in self._watchers:
            with self._letting_go(watcher):
                self._hear(watcher, now, now_us * 1e-6)
            watcher.askers.forget_silent(now_us * 1e-6)
        for watcher, address, asker in self._all():
            if asker.pace is not None:
                self._say(watcher, address, asker, self._services.due(asker.pace, now, now_us))

    def tell(self, messages: Sequence[Message]) -> None:
        """Send all of them what they did not ask for."""
        for watcher, address, asker in self._all():
            self._say(watcher, address, asker, messages)

    def take_lost(self) -> list[str]:
        """The links of those let go since the last call."""
        lost, self._lost = self._lost, []
        return lost

    @property
    def listeners(self) -> list[Listener]:
        """All that is listened to."""
        return [watcher.listener for watcher in self._watchers]

    def _all(self) -> Iterator[tuple[Watcher, Address | None, Asker]]:
        for watcher in self._watchers:
            for address, asker in watcher.askers.known():
                yield watcher, address, asker

    def _hear(self, watcher: Watcher, state: RobotState, now: float) -> None:
        while watcher.ration.left(now) > 0:
            frames = watcher.listener.listen(0.0)
            taken = watcher.listener.taken
            if not taken:
                return
            watcher.ration.take(taken)
            if frames:
                self._answer(watcher, frames, state, now)

    def _answer(
        self, watcher: Watcher, frames: Sequence[Frame], state: RobotState, now: float
    ) -> None:
        address = watcher.listener.link.sender
        asker = watcher.askers.heard_from(address, now)
        if address is not None:
            watcher.askers.forget(None)  # no longer one far end, but everybody who speaks
        for frame in frames:
            replies = self._services.answer(frame, state, asker, watcher.trusts(frame))
            self._say(watcher, address, asker, replies)

    def _say(
        self, watcher: Watcher, address: Address | None, asker: Asker, messages: Sequence[Message]
    ) -> None:
        with self._letting_go(watcher, address):
            watcher.say(messages, asker, address)

    @contextmanager
    def _letting_go(self, watcher: Watcher, address: Address | None = None) -> Iterator[None]:
        """Let go a link that breaks; of many on one link, only the one whom nothing reaches."""
        try:
            yield
        except EndpointError:
            if address is not None:
                watcher.askers.forget(address)
            elif watcher in self._watchers:
                self._watchers = [each for each in self._watchers if each is not watcher]
                self._lost.append(watcher.listener.link.name)
