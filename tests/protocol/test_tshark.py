"""Wireshark, with the dissector that we generate, names our fields."""

import re
import shutil
import struct
import subprocess

import pytest

from laglab_protocol import Measurement
from laglab_protocol.dialect.mavgen import dialect_path, generate
from laglab_protocol.messages.layout import layout_of

from .golden import GOLDEN, Golden

PORT = 14550


def pcap(datagrams: list[bytes]) -> bytes:
    """A capture of these as UDP to a MAVLink port (link type 228: bare IPv4)."""
    captured = struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, 228)
    for number, datagram in enumerate(datagrams):
        udp = struct.pack(">HHHH", PORT, PORT, 8 + len(datagram), 0) + datagram
        local = bytes([127, 0, 0, 1])
        ip = struct.pack(">BBHHHBBH", 0x45, 0, 20 + len(udp), number, 0, 64, 17, 0) + local + local
        packet = ip + udp
        captured += struct.pack("<IIII", number, 0, len(packet), len(packet)) + packet
    return captured


@pytest.fixture(scope="module")
def dissected(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    tshark = shutil.which("tshark")
    if tshark is None:  # an apt package: CI installs it
        pytest.skip("tshark is not installed: apt-get install tshark")
    folder = tmp_path_factory.mktemp("tshark")
    generate(dialect_path(), "WLua", folder / "laglab.lua")
    (folder / "golden.pcap").write_bytes(pcap([row.raw for row in GOLDEN]))
    done = subprocess.run(
        [tshark, "-X", f"lua_script:{folder / 'laglab.lua'}", "-r", folder / "golden.pcap", "-V"],
        capture_output=True,
        text=True,
        check=True,
        timeout=50,
    )
    packets = re.split(r"^Frame \d+: ", done.stdout, flags=re.MULTILINE)[1:]
    assert len(packets) == len(GOLDEN)
    return packets


@pytest.mark.parametrize("index", range(len(GOLDEN)), ids=lambda i: GOLDEN[i].name)
def test_tshark_names_the_message_and_its_fields(dissected: list[str], index: int) -> None:
    row, text = GOLDEN[index], dissected[index]

    assert layout_of(row.message).name in text
    for field in row.message.__struct_fields__:
        assert f"{field} (" in text or f"{field}[0] (" in text, text


def measured(row: Golden) -> bool:
    return row.name == "a measurement"


def test_tshark_reads_the_values(dissected: list[str]) -> None:
    (index,) = [index for index, row in enumerate(GOLDEN) if measured(row)]
    message = GOLDEN[index].message

    assert isinstance(message, Measurement)
    assert f"x (double) [m]: {message.x}" in dissected[index]
    assert f"tick (uint32_t): {message.tick}" in dissected[index]
