"""One rehearsal: start the two sides, follow them, and keep what they leave."""

import tempfile
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from multiprocessing.connection import wait
from pathlib import Path
from typing import Any, Literal

from laglab.run.inline import InlineEndpoint
from laglab.run.processes import (
    SIDE_ERRORS,
    Answered,
    Failed,
    Finished,
    Listening,
    LoopClock,
    Progress,
    Report,
    Side,
    gateway_process,
    started,
    station_process,
)
from laglab.run.robot_side import Setup, open_robot
from laglab.run.station_side import open_station, station_statistics
from laglab.scenario import Scenario
from laglab_gateway import FileRecorder, Outcome, Patience

Transport = Literal["inline", "udp", "serial"]

SCENARIO_FILE = "scenario.toml"
NOTICE_SECONDS = 1.0
"""What a gateway needs, besides the silence timeout, to say that its station is silent."""


@dataclass(frozen=True)
class Ending:
    """How the two sides ended: an outcome, or the problem that cut them short."""

    outcome: Outcome | None
    problem: str | None
    loop_seconds: float
    statistics: dict[str, Any]


def rehearse(
    scenario: Scenario,
    transport: Transport,
    directory: Path,
    progress: Callable[[int], None],
    setup: Setup | None = None,
) -> Ending:
    """Run both sides to the end; trace, log and scenario are then in `directory`.

    A real robot does not wait for a station, so it cannot be part of an inline run.
    """
    setup = setup or Setup()
    directory.mkdir(parents=True, exist_ok=True)
    (directory / SCENARIO_FILE).write_text(scenario.to_toml(directory), encoding="utf-8")
    if transport == "inline":
        return _inline(scenario, directory, progress, setup)
    with _gateway_url(transport) as url:
        return _two_processes(scenario, url, directory, progress, setup)


def _inline(
    scenario: Scenario, directory: Path, progress: Callable[[int], None], setup: Setup
) -> Ending:
    clock = LoopClock(progress)
    try:
        with (
            open_robot(scenario, setup) as serve,
            open_station(scenario, setup.key) as station,
            closing(FileRecorder(directory)) as recorder,
        ):
            endpoint = InlineEndpoint(station)
            outcome, statistics = serve(endpoint, recorder, Patience(), clock)
    except SIDE_ERRORS as error:
        return Ending(None, str(error), clock.seconds, {})
    return Ending(outcome, None, clock.seconds, statistics | station_statistics(station))


@contextmanager
def _gateway_url(transport: Transport) -> Iterator[str]:
    if transport == "udp":
        yield "udpin://127.0.0.1:0"
    else:
        with tempfile.TemporaryDirectory(prefix="laglab-") as directory:
            yield f"pty://{directory}/robot"


def far_end(address: str) -> str:
    """The address a station opens to reach a gateway that listens at ``address``."""
    scheme, _, place = address.partition("://")
    return f"udpout://{place}" if scheme == "udpin" else f"serial://{place}:57600"


def _two_processes(
    scenario: Scenario,
    url: str,
    directory: Path,
    progress: Callable[[int], None],
    setup: Setup,
) -> Ending:
    notice = scenario.silence_timeout + NOTICE_SECONDS
    with started("gateway", gateway_process, scenario, url, directory, setup) as gateway:
        match gateway.next_report():
            case Listening(address):
                station_url = far_end(address)
            case report:
                return _ending(report, [], 0.0, {})
        with started("controller", station_process, scenario, station_url, setup) as station:
            try:
                return _follow(gateway, station, notice, progress)
            except KeyboardInterrupt:
                gateway.stop()
                return _follow(gateway, station, notice, progress)


def _follow(gateway: Side, station: Side, notice: float, progress: Callable[[int], None]) -> Ending:
    """Read both sides' reports until the gateway's last one.

    A gateway whose station is gone gets `notice` seconds to find and say so, and no more.
    """
    problems: list[str] = []
    told: dict[str, Any] = {}
    loop_seconds = 0.0
    watched = [gateway.reports, station.reports]
    while ready := wait(watched, timeout=notice if problems else None):
        if station.reports in ready:
            watched.remove(station.reports)
            match station.next_report():
                case Failed(reason):
                    problems.append(reason)
                case Answered(told):
                    pass
        if gateway.reports in ready:
            match gateway.next_report():
                case Progress(tick, loop_seconds):
                    progress(tick)
                case report:
                    told = told or _last_words(station)
                    return _ending(report, problems, loop_seconds, told)
    return Ending(None, "; ".join(problems), loop_seconds, {})


def _last_words(station: Side) -> dict[str, Any]:
    """The station's statistics; nothing when it ends without."""
    if not station.reports.poll(NOTICE_SECONDS):
        return {}
    report = station.next_report()
    return report.statistics if isinstance(report, Answered) else {}


def _ending(
    report: Report, problems: list[str], loop_seconds: float, told: dict[str, Any]
) -> Ending:
    match report:
        case Finished(outcome, seconds, statistics):
            return Ending(outcome, None, seconds, statistics | told)
        case Failed(reason):
            return Ending(None, "; ".join([reason, *problems]), loop_seconds, {})
        case _:
            raise AssertionError(f"{report} ends no run")
