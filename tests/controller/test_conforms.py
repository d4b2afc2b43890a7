"""The conformance kit passes our own controller, over UDP and a serial line, signed and not."""

import threading
from contextlib import ExitStack
from pathlib import Path

import pytest

from laglab_conformance import conform
from laglab_control import StationConfig
from laglab_protocol import (
    STATION_COMPONENT,
    STATION_SYSTEM,
    Codec,
    Endpoint,
    Listener,
    make_key,
    open_endpoint,
)
from laglab_station import Station, run_station


@pytest.mark.slow
@pytest.mark.parametrize("signed", [False, True], ids=["unsigned", "signed"])
@pytest.mark.parametrize("line", ["udp", "serial"])
def test_our_controller_conforms(tmp_path: Path, line: str, signed: bool) -> None:
    key_file = tmp_path / "key" if signed else None
    if key_file:
        make_key(key_file)
    with ExitStack() as stack:
        if line == "udp":
            with open_endpoint("udpin://:0") as free:
                url = free.name
            endpoint = stack.enter_context(open_endpoint(url.replace("udpin", "udpout")))
        else:
            endpoint = stack.enter_context(open_endpoint(f"pty://{tmp_path / 'station'}"))
            url = f"serial://{tmp_path / 'station'}:57600"
        station = threading.Thread(target=run, args=(endpoint, key_file))
        station.start()
        try:
            report = conform(url, "controller", key_file)
        finally:
            station.join()

    assert report.failed == [], report.table()


def run(endpoint: Endpoint, key_file: Path | None) -> None:
    with Codec(STATION_SYSTEM, STATION_COMPONENT, key_file) as codec:
        station = Station(StationConfig(estimator="delayed-ekf", plan=40), sender=codec.sender)
        run_station(station, Listener(endpoint, codec.receiver))
