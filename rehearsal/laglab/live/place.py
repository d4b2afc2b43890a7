"""Where a live page is to be: `--live [[HOST:]PORT]`."""

import re
from collections.abc import Sequence
from ipaddress import ip_address
from typing import NamedTuple

from laglab.errors import LiveError

LOOPBACK = "127.0.0.1"
OPTION = "--live"
VALUE = re.compile(r"(?:(?P<host>\S+):)?(?P<port>\d{1,5})")


class Place(NamedTuple):
    """Port 0: one from the system."""

    host: str
    port: int

    @property
    def local(self) -> bool:
        """Whether nobody but this machine can reach it."""
        return is_local(self.host)


def is_local(host: str) -> bool:
    """By its name or its number."""
    try:
        return ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return host == "localhost"


def place_of(told: str) -> Place:
    """What the option says. Raises LiveError."""
    found = VALUE.fullmatch(told)
    if found is None or int(found["port"]) > 65535:
        raise LiveError(f"{OPTION} {told}: not a PORT nor HOST:PORT")
    return Place((found["host"] or LOOPBACK).strip("[]"), int(found["port"]))


def spelled_out(arguments: Sequence[str]) -> list[str]:
    """With a value behind every `--live`, which may stand alone: no option of typer's may."""
    following = [*arguments, ""][1:]
    return [
        f"{OPTION}=0" if each == OPTION and not VALUE.fullmatch(after) else each
        for each, after in zip(arguments, following, strict=True)
    ]
