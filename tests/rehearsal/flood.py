"""A stranger who does not stop: `python flood.py SECONDS KIND PORT...`, as fast as it can.

Kinds: garbage, frames (of somebody else's), signatures (of another key), requests, all.
"""

import itertools
import socket
import sys
import time

from laglab_protocol import Heartbeat, ParamRequestList, Ping, Sender
from laglab_protocol.signing.signature import Signer

ANOTHER_KEY = bytes(32)


def datagrams(kind: str) -> list[bytes]:
    """Each as long as a path carries, and one short."""
    stranger = Sender(7, 7)
    signed = Sender(200, 190, Signer(ANOTHER_KEY, (0, 200, 190)))
    kinds = {
        "garbage": b"\xfd" * 1400,
        "frames": b"".join(stranger.frame(Heartbeat(0, 6, 8, 0, 4, 3)) for _ in range(60)),
        "signatures": b"".join(signed.frame(Heartbeat(0, 6, 8, 0, 4, 3)) for _ in range(40)),
        "requests": stranger.frame(ParamRequestList(1, 1)) * 60
        + stranger.frame(Ping(1, 1, 0, 0)) * 10,
    }
    long = list(kinds.values()) if kind == "all" else [kinds[kind]]
    return [*long, long[-1][:21]]


def main(seconds: float, kind: str, ports: list[int]) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ours:
        until = time.monotonic() + seconds
        sent = 0
        for data, port in itertools.cycle(itertools.product(datagrams(kind), ports)):
            ours.sendto(data, ("127.0.0.1", port))
            sent += 1
            if sent % 256 == 0 and time.monotonic() > until:
                break
    print(sent)


if __name__ == "__main__":
    main(float(sys.argv[1]), sys.argv[2], [int(port) for port in sys.argv[3:]])
