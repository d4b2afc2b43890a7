"""libmav, a peer that shares no code with us, exchanges our own messages with us."""

import queue
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import libmav
import pytest
from msgspec.structs import asdict

from laglab_protocol import Endpoint, Frame, Message, Receiver, Sender, open_endpoint
from laglab_protocol.dialect.mavgen import carried_dialects, dialect_path
from laglab_protocol.messages.layout import layout_of

from .golden import GOLDEN, Golden

OURS = [row for row in GOLDEN if layout_of(row.message).id >= 52100]
rows = pytest.mark.parametrize("row", OURS, ids=lambda row: row.name)
HEARTBEAT = next(row for row in GOLDEN if row.message not in [each.message for each in OURS])


class Libmav:
    """libmav's side of a UDP link, connected."""

    def __init__(self, folder: Path, endpoint: Endpoint) -> None:
        self.messages = libmav.MessageSet(str(folder / "laglab.xml"))
        port = int(endpoint.name.rpartition(":")[2])
        client = libmav.UDPClient("127.0.0.1", port)
        identity = libmav.Identifier(200, 190)
        self.runtime = libmav.NetworkRuntime(identity, self.messages, self._heartbeat(), client)
        self.heard: queue.Queue[dict[str, Any]] = queue.Queue()
        endpoint.receive(5.0)
        endpoint.accept_peer()
        endpoint.send(HEARTBEAT.raw)
        self.connection = self.runtime.await_connection(5000)
        self.connection.add_message_callback(lambda message: self.heard.put(message.to_dict()))

    def _heartbeat(self) -> Any:
        fields = {"type": 6, "autopilot": 8, "base_mode": 0, "custom_mode": 0}
        rest = {"system_status": 4, "mavlink_version": 3}
        return self.messages.create("HEARTBEAT").set_from_dict(fields | rest)

    def send(self, message: Message) -> None:
        fields = asdict(message)
        self.connection.send(self.messages.create(layout_of(message).name).set_from_dict(fields))


@pytest.fixture(scope="module")
def endpoint() -> Iterator[Endpoint]:
    with open_endpoint("udpin://127.0.0.1:0") as opened:
        yield opened


@pytest.fixture(scope="module")
def peer(tmp_path_factory: pytest.TempPathFactory, endpoint: Endpoint) -> Iterator[Libmav]:
    folder = tmp_path_factory.mktemp("xml")
    for xml in [*carried_dialects().glob("*.xml"), dialect_path()]:
        shutil.copy(xml, folder)
    peer = Libmav(folder, endpoint)
    yield peer
    peer.runtime.stop()


def next_of_ours(endpoint: Endpoint) -> Frame:
    receiver = Receiver()
    while data := endpoint.receive(5.0):
        for frame in receiver.receive(data, whole=True):
            if layout_of(frame.message).id >= 52100:
                return frame
    raise AssertionError("libmav sent nothing of ours")


@rows
def test_libmav_reads_these_fields(row: Golden, peer: Libmav, endpoint: Endpoint) -> None:
    endpoint.send(Sender(row.system, row.component).frame(row.message))
    wanted = layout_of(row.message).name
    while (heard := peer.heard.get(timeout=5.0))["_name"] != wanted:
        pass

    fields = asdict(row.message)
    assert {name: repr(heard[name]) for name in fields} == {
        name: repr(list(value) if isinstance(value, tuple) else value)
        for name, value in fields.items()
    }


@rows
def test_libmav_makes_these_bytes(row: Golden, peer: Libmav, endpoint: Endpoint) -> None:
    peer.send(row.message)

    assert next_of_ours(endpoint).raw[10:-2] == row.raw[10:-2]
