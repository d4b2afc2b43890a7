"""The conformance kit passes our own controller, over UDP and over a serial line."""

import threading
from contextlib import ExitStack
from pathlib import Path

import pytest

from laglab_controller import Station, StationConfig, run_station
from laglab_protocol import Endpoint, open_endpoint
from laglab_protocol.conform import conform


@pytest.mark.slow
@pytest.mark.parametrize("line", ["udp", "serial"])
def test_our_controller_conforms(tmp_path: Path, line: str) -> None:
    with ExitStack() as stack:
        if line == "udp":
            with open_endpoint("udpin://:0") as free:
                url = free.name
            endpoint = stack.enter_context(open_endpoint(url.replace("udpin", "udpout")))
        else:
            endpoint = stack.enter_context(open_endpoint(f"pty://{tmp_path / 'station'}"))
            url = f"serial://{tmp_path / 'station'}:57600"
        station = threading.Thread(target=run, args=(endpoint,))
        station.start()
        try:
            report = conform(url, "controller")
        finally:
            station.join()

    assert report.failed == [], report.table()


def run(endpoint: Endpoint) -> None:
    run_station(Station(StationConfig(estimator="delayed-ekf")), endpoint)
