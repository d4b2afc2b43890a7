"""What a small robot and a small controller have in common; each has one fault if told so."""

import threading
import time
from pathlib import Path
from typing import Self

from msgspec.structs import replace

from laglab_conformance.forge import Forged
from laglab_protocol import Codec, Endpoint, Frame, Heartbeat, Message, Sender, Settings, Signer

from .faulty_intake import INTAKE

REPEAT_AFTER = 0.03
ALIVE = Heartbeat(0, 10, 0, 0, 4, 3)


class Peer(threading.Thread):
    """Listens until END, or until it is left; `fault` is what it does wrong."""

    system, component = 1, 1
    master = (200, 190)

    def __init__(self, endpoint: Endpoint, fault: str, key_file: Path | None) -> None:
        super().__init__()
        self.endpoint = endpoint
        self.fault = fault
        self.codec = Codec(self.system, self.component, key_file)
        self.open = Codec(self.system, self.component)
        self.left = threading.Event()
        self.deaf = 0
        self.slow = False

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.left.set()
        self.join()
        self.codec.close()

    def run(self) -> None:
        while not self.left.is_set():
            self.listen(REPEAT_AFTER)

    def listen(self, seconds: float) -> None:
        data = self.endpoint.receive(seconds)
        if not data:
            self.silence()
        for frame in self.intake(data):
            self.endpoint.accept_peer()
            if self.obeys(frame):
                self.hear(frame.message)

    def obeys(self, frame: Frame) -> bool:
        if self.fault == "obeys any component":
            return frame.system == self.master[0]
        if self.fault == "obeys anybody":
            return frame.component == self.master[1]
        return (frame.system, frame.component) == self.master

    def silence(self) -> None:
        """Nothing came for a while."""

    def hear(self, message: Message) -> None:
        """A message came from the other side."""

    def intake(self, data: bytes) -> list[Frame]:
        if self.deaf and data:
            self.deaf -= 1
            return []
        data = INTAKE.get(self.fault, lambda _, data: data)(self, data)
        receiver = self.codec.receiver
        if self.fault == "believes the unsigned" and data[:1] == b"\xfd" and not data[2]:
            receiver = self.open.receiver
        return receiver.receive(data, whole=True)

    def send(self, *messages: Message) -> None:
        if self.slow:
            time.sleep(0.3)  # more than the kit allows
        raw = b"".join(self.framed(message) for message in messages)
        self.endpoint.send(raw + (b"?" if self.fault == "sends stray bytes" else b""))
        if self.fault == "signs without a key":
            stream = 1, self.system, self.component
            signed = Sender(self.system, self.component, Signer(bytes(32), stream))
            self.endpoint.send(signed.frame(ALIVE))
        if self.fault == "signs not all":
            self.endpoint.send(Sender(self.system, self.component).frame(ALIVE))

    def settings(self) -> Settings:
        told = Settings(0.01)
        return replace(told, dialect=99) if self.fault == "speaks another dialect" else told

    def framed(self, message: Message) -> bytes:
        raw = self.codec.sender.frame(message)
        if self.fault == "skips numbers":
            self.codec.sender.frame(message)
        if self.fault == "speaks as another":
            return Forged.of(message, 7, self.component, raw[4], None).raw
        if self.fault == "sends zeros":
            forged = Forged.of(message, self.system, self.component, raw[4], None)
            return forged.untrimmed(message).raw
        return raw
