"""mavsdk, given our XML (MavlinkDirect.load_custom_xml), reads and sends our own messages."""

import json
import math
import os
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import IO, NamedTuple

import pytest
from msgspec.structs import asdict

from laglab_protocol import Command, Endpoint, Frame, Plan, Recall, Receiver, Sender, open_endpoint
from laglab_protocol.messages.layout import layout_of

from .golden import GOLDEN, Golden, numbers

HEARTBEAT = GOLDEN[-1].message
FINITE = [
    row
    for row in GOLDEN
    if layout_of(row.message).id >= 52100 and all(map(math.isfinite, numbers(row.message)))
]
"""mavsdk passes fields as JSON, which has no NaN."""
FOR_A_STATION = [row for row in FINITE if not isinstance(row.message, Command | Plan | Recall)]
"""It does not show what is addressed to the robot."""


class Peer(NamedTuple):
    """A mavsdk program, and our end of the link to it."""

    endpoint: Endpoint
    say: IO[str]
    told: IO[str]


def beat(endpoint: Endpoint, done: threading.Event) -> None:
    sender = Sender(1, 1)
    while not done.wait(0.2):
        endpoint.send(sender.frame(HEARTBEAT))


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@pytest.fixture(scope="module")
def peer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Peer]:
    port, done, pipe = free_port(), threading.Event(), subprocess.PIPE
    environment = os.environ | {"TMPDIR": str(tmp_path_factory.mktemp("mavsdk"))}
    command = [sys.executable, Path(__file__).parent / "mavsdk_peer.py", str(port)]
    with (
        open_endpoint(f"udpout://127.0.0.1:{port}") as endpoint,
        subprocess.Popen(command, env=environment, stdin=pipe, stdout=pipe, text=True) as process,
    ):
        beating = threading.Thread(target=beat, args=(endpoint, done))
        beating.start()
        try:
            assert process.stdin is not None
            assert process.stdout is not None
            assert "ready\n" in iter(process.stdout.readline, "")
            yield Peer(endpoint, process.stdin, process.stdout)
        finally:
            done.set()
            beating.join()
            process.kill()


@pytest.mark.slow
@pytest.mark.parametrize("row", FOR_A_STATION, ids=lambda row: row.name)
def test_mavsdk_reads_these_fields(row: Golden, peer: Peer) -> None:
    peer.endpoint.send(Sender(1, 1).frame(row.message))
    told = json.loads(peer.told.readline())

    read, fields = json.loads(told["fields"]), json.loads(json.dumps(asdict(row.message)))
    assert told["name"] == layout_of(row.message).name
    assert {name: read[name] for name in fields} == fields


@pytest.mark.slow
@pytest.mark.parametrize("row", FINITE, ids=lambda row: row.name)
def test_mavsdk_makes_these_bytes(row: Golden, peer: Peer) -> None:
    name, fields = layout_of(row.message).name, asdict(row.message)
    peer.say.write(json.dumps({"name": name, "fields": fields}) + "\n")
    peer.say.flush()

    assert next_named(peer.endpoint, name).raw[10:-2] == row.raw[10:-2]


def next_named(endpoint: Endpoint, name: str) -> Frame:
    receiver, deadline = Receiver(), time.monotonic() + 10.0
    while time.monotonic() < deadline:
        data = endpoint.receive(1.0)
        for frame in receiver.receive(data, whole=True):
            if layout_of(frame.message).name == name:
                return frame
    raise AssertionError(f"mavsdk sent no {name}")
