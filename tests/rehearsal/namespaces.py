"""Machines of our own: network namespaces, joined by cables."""

import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import NamedTuple

import pytest


class Socket(NamedTuple):
    """Where a cable is plugged in."""

    machine: str
    device: str
    address: str


def run(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(words, capture_output=True, text=True, check=False)


def needed(*words: str) -> None:
    """Run it; a machine that does not let us is no machine for these tests."""
    if shutil.which(words[0]) is None:
        pytest.skip(f"no `{words[0]}` here: install iproute2")
    result = run(*words)
    if result.returncode:
        pytest.skip(f"`{' '.join(words)}`: {result.stderr.strip()}")


@contextmanager
def machines(*names: str) -> Iterator[list[str]]:
    """Namespaces of these names and our own number; gone afterwards, whatever happened."""
    with ExitStack() as stack:
        made = [f"laglab-{name}-{os.getpid()}" for name in names]
        for name in made:
            needed("ip", "netns", "add", name)
            stack.callback(run, "ip", "netns", "del", name)
            needed("ip", "-n", name, "link", "set", "lo", "up")
        yield made


def joined(first: str, second: str, network: str, letters: str) -> tuple[Socket, Socket]:
    """Two machines with a veth pair between them, .1 and .2 of the network; `letters` tell its
    ends from others'."""
    ends = tuple(
        Socket(machine, f"lg{letter}{os.getpid()}", f"{network}.{number}")
        for machine, letter, number in zip((first, second), letters, (1, 2), strict=True)
    )
    one, other = ends
    peer = ("peer", "name", other.device, "netns", other.machine)
    needed("ip", "link", "add", one.device, "netns", one.machine, "type", "veth", *peer)
    for end in ends:
        needed("ip", "-n", end.machine, "addr", "add", f"{end.address}/30", "dev", end.device)
        needed("ip", "-n", end.machine, "link", "set", end.device, "up")
    return one, other


def inside(machine: str, *command: str) -> tuple[str, ...]:
    """The command, on that machine."""
    return ("ip", "netns", "exec", machine, *command)


def emulate(end: Socket, *netem: str) -> None:
    """Let what leaves here be what netem is told, where the kernel has it."""
    needed("tc", "-n", end.machine, "qdisc", "add", "dev", end.device, "root", "netem", *netem)
