"""The station's thin loop: a clock and an endpoint around the core."""

import time
from collections.abc import Callable

from laglab_protocol import End, Endpoint, EndReason
from laglab_station.errors import RobotSilentError
from laglab_station.station import Station

HEARTBEAT_PERIOD = 0.1
"""[s] between heartbeats while the robot has not been heard."""


def run_station(
    station: Station,
    endpoint: Endpoint,
    silence_timeout: float = 3.0,
    warn: Callable[[str], None] | None = None,
) -> End:
    """Make the station known, then answer the robot until one side ends the run; say what ended it.

    `warn` is told at once when the station has something to warn of, and once only.
    Raises RobotSilentError when the robot, once heard, says nothing for `silence_timeout` seconds,
    and EndpointError when the endpoint fails. Interrupted by the keyboard, it tells the robot.
    """
    try:
        _introduce(station, endpoint)
        return _answer_until_end(station, endpoint, silence_timeout, warn)
    except KeyboardInterrupt:
        endpoint.send(station.end(EndReason.INTERRUPTED))
        raise


def _introduce(station: Station, endpoint: Endpoint) -> None:
    while station.tick is None and not station.closed:
        endpoint.send(station.heartbeat())
        _answer(station, endpoint, HEARTBEAT_PERIOD)


def _answer_until_end(
    station: Station,
    endpoint: Endpoint,
    silence_timeout: float,
    warn: Callable[[str], None] | None,
) -> End:
    heard = time.monotonic()
    while not station.closed:
        if _answer(station, endpoint, silence_timeout):
            heard = time.monotonic()
        elif time.monotonic() - heard >= silence_timeout:
            break
        if warn and station.warning:
            warn(station.warning)
            warn = None
    if station.outcome is None:
        raise RobotSilentError(
            f"{endpoint.name}: the robot has been silent for {silence_timeout:g} s, since its tick "
            f"{station.tick}: see whether its process still runs and the link is up"
        )
    return station.outcome


def _answer(station: Station, endpoint: Endpoint, timeout: float) -> bool:
    """Whether something came that was worth an answer."""
    data = endpoint.receive(timeout)
    answer = station.receive(data, endpoint.datagrams) if data else b""
    if answer:
        endpoint.accept_peer()
        endpoint.send(answer)
        station.look_ahead()
    return bool(answer)
