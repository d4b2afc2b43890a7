"""Those who look on: ground stations on links of their own, apart from the loop's."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic_ns
from typing import NamedTuple

from laglab_gateway.services import RobotState, Services
from laglab_protocol import EndpointError, Listener, Message, Sender

POLL_US = 20_000
"""How often they are looked after; in between the loop is not held up for them."""

MOST_AT_ONCE = 32
"""Pieces of what one of them says that are looked at each time; the rest has to wait."""


class Watcher(NamedTuple):
    """One link, and who makes the frames on it."""

    listener: Listener
    sender: Sender


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
                self._hear(watcher, now)
        self.tell(self._services.due(now, now_us))

    def tell(self, messages: list[Message]) -> None:
        """Send them what they did not ask for."""
        for watcher in self._watchers:
            with self._letting_go(watcher):
                for message in messages:
                    watcher.listener.link.send(watcher.sender.frame(message))

    def take_lost(self) -> list[str]:
        """The links of those let go since the last call."""
        lost, self._lost = self._lost, []
        return lost

    @contextmanager
    def _letting_go(self, watcher: Watcher) -> Iterator[None]:
        try:
            yield
        except EndpointError:
            self._watchers = [each for each in self._watchers if each is not watcher]
            self._lost.append(watcher.listener.link.name)

    def _hear(self, watcher: Watcher, state: RobotState) -> None:
        listener, sender = watcher
        for _ in range(MOST_AT_ONCE):
            frames = listener.listen(0.0)
            if listener.idle:
                return
            if frames:
                listener.link.accept_peer()
            for frame in frames:
                for message in self._services.answer(frame, state):
                    listener.link.send(sender.frame(message))
