"""Those who look on: ground stations on links of their own, apart from the loop's."""

from time import monotonic_ns
from typing import NamedTuple

from laglab_gateway.services import RobotState, Services
from laglab_protocol import Codec, Endpoint, Message

POLL_US = 20_000
"""How often they are looked after; in between the loop is not held up for them."""


class Watcher(NamedTuple):
    """One link, and the frames that go over it."""

    endpoint: Endpoint
    codec: Codec


class Watch:
    """Answers the watchers' requests, and sends them telemetry.

    LAGLAB_COMMAND counts on the loop's own link alone, so they may stop the robot, not drive it.
    """

    def __init__(self, services: Services, watchers: list[Watcher]) -> None:
        self._services = services
        self._watchers = watchers
        self._next_us = 0

    def poll(self, state: RobotState) -> None:
        """Look after them, if it is time; costs next to nothing when it is not.

        Raises:
            EndpointError: a watcher's link broke.
        """
        now_us = monotonic_ns() // 1000
        if now_us < self._next_us:
            return
        self._next_us = now_us + POLL_US
        telemetry = self._services.due(state, now_us)
        for watcher in self._watchers:
            self._hear(watcher, state)
        self.tell(telemetry)

    def tell(self, messages: list[Message]) -> None:
        """Send them what they did not ask for."""
        for endpoint, codec in self._watchers:
            for message in messages:
                endpoint.send(codec.sender.frame(message))

    def _hear(self, watcher: Watcher, state: RobotState) -> None:
        endpoint, codec = watcher
        sender, receiver = codec.sender, codec.receiver
        while data := endpoint.receive(0.0):
            frames = receiver.receive(data)
            if endpoint.datagrams:
                frames += receiver.end_datagram()
            if frames:
                endpoint.accept_peer()
            for frame in frames:
                for message in self._services.answer(frame, state):
                    endpoint.send(sender.frame(message))
