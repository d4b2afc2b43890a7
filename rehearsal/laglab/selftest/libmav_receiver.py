"""libmav's parser, which only its own socket feeds: what we receive is sent on to it."""

import queue
import shutil
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

from laglab.c_library import new_folder
from laglab.selftest.receivers import message_of
from laglab_protocol import (
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_HEARTBEAT,
    STATION_SYSTEM,
    Frame,
    Receiver,
    Sender,
    open_endpoint,
)
from laglab_protocol.dialect.mavgen import carried_dialects, dialect_path

READS_WITHIN = 0.1
"""[s] To wait for it: it reads in its own thread, and does not say when it found nothing."""
THE_REST_WITHIN = 0.005
"""[s] What else was in the same datagram follows that soon."""
CONNECTS_WITHIN = 5.0


class LibmavReceiver(Receiver):
    """libmav's, over loopback."""

    def __init__(self, stack: ExitStack) -> None:
        """Raises ModuleNotFoundError when libmav is not installed."""
        import libmav

        super().__init__()
        self._found: queue.Queue[Frame] = queue.Queue()
        self._link = stack.enter_context(open_endpoint("udpin://127.0.0.1:0"))
        # What libmav reads points into the set, which it does not keep.
        messages = self._messages = libmav.MessageSet(str(_dialect(stack)))
        client = libmav.UDPClient("127.0.0.1", int(self._link.name.rpartition(":")[2]))
        identity = libmav.Identifier(ROBOT_SYSTEM, ROBOT_COMPONENT)
        self._runtime = libmav.NetworkRuntime(identity, messages, _heartbeat(messages), client)
        stack.callback(self._runtime.stop)
        self._connection = self._connected()
        self._connection.add_message_callback(self._take)

    def _connected(self) -> Any:
        """It listens to nobody who has not sent a heartbeat."""
        self._link.receive(CONNECTS_WITHIN)
        self._link.accept_peer()
        self._link.send(Sender(STATION_SYSTEM, STATION_COMPONENT).frame(STATION_HEARTBEAT))
        return self._runtime.await_connection(round(CONNECTS_WITHIN * 1000))

    def _take(self, read: Any) -> None:
        header = read.header
        source = header.system_id, header.component_id, header.seq
        self._found.put(Frame(message_of(read.name, read.to_dict()), *source, b""))

    def receive(self, data: bytes, whole: bool = False) -> list[Frame]:
        del whole
        while self._link.receive(0.0):
            pass  # its own heartbeats
        self._link.send(data)
        found: list[Frame] = []
        with suppress(queue.Empty):
            found.append(self._found.get(timeout=READS_WITHIN))
            while True:
                found.append(self._found.get(timeout=THE_REST_WITHIN))
        return found


def _dialect(stack: ExitStack) -> Path:
    """Ours, beside those that it includes."""
    folder = new_folder(stack)
    for xml in [*carried_dialects().glob("*.xml"), dialect_path()]:
        shutil.copy(xml, folder)
    return folder / dialect_path().name


def _heartbeat(messages: Any) -> Any:
    fields = {"type": 10, "autopilot": 0, "base_mode": 0, "custom_mode": 0}
    rest = {"system_status": 4, "mavlink_version": 3}
    return messages.create("HEARTBEAT").set_from_dict(fields | rest)
