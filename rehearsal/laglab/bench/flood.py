"""What strangers cost the loop, who send as fast as one process can, on its link and where ground
stations look on: how late ticks on the wall clock begin, and how many deadlines are missed.
"""

import itertools
import socket
import tempfile
from collections.abc import Sequence
from contextlib import ExitStack, suppress
from pathlib import Path
from queue import Queue
from typing import get_args
from urllib.parse import urlsplit

from msgspec import Struct

from laglab.bench.harness import MILLISECONDS, Bench, Contest, Progress, Turn
from laglab.bench.result import Figure, Result
from laglab.bench.whole_run import realtime_scenario, whole
from laglab.runs.alone import serve_alone
from laglab.runs.processes.child import Tell, started
from laglab.runs.processes.reports import Order
from laglab.runs.rehearse import far_end
from laglab.runs.robot_side import Setup, open_robot
from laglab.scenario import Scenario
from laglab.soak.strangers import datagrams
from laglab.soak.turn import Strangers
from laglab_gateway import FileRecorder, Patience, Surroundings, TimingReport
from laglab_protocol import Endpoint, Listener, open_endpoint

NOBODY, FLOOD = "nobody else", "a flood"
LOCAL = "udpin://127.0.0.1:0"
PATIENT = 9.0
"""[s] The machine has three processes to run."""


class Ports(Struct, frozen=True):
    """Where strangers send to, on this machine."""

    ports: tuple[int, ...]


def bench(seconds: float) -> Bench:
    """Runs of `seconds` over UDP; a turn gives the 99th percentile of its ticks' lateness."""
    scenario, reports = realtime_scenario(seconds), dict[str, list[TimingReport]]()

    def turn(name: str) -> Turn:
        reports[name] = []

        def late() -> float:
            reports[name].append(_timing(scenario, flooded=name == FLOOD))
            return reports[name][-1].p99_s

        return late

    def missed(_: Sequence[Result], __: Progress) -> list[Figure]:
        ticks = scenario.must_end() + 1
        return [
            Figure(
                f"deadlines missed: {name}",
                100 * sum(each.missed_deadlines for each in of) / (ticks * len(of)),
                "%",
            )
            for name, of in reports.items()
        ]

    ways = {name: turn(name) for name in (NOBODY, FLOOD)}
    contest = Contest("ticks late by, p99", MILLISECONDS, NOBODY, {"real time, 100 Hz": ways})
    return Bench("flood", [contest], missed)


def _timing(scenario: Scenario, flooded: bool) -> TimingReport:
    with (
        ExitStack() as stack,
        tempfile.TemporaryDirectory(prefix="laglab-bench-") as folder,
        open_robot(scenario, Setup()) as robot,
        open_endpoint(LOCAL) as link,
        open_endpoint(LOCAL) as watch,
    ):
        order = Order(scenario.to_toml(), far_end(link.name))
        side = "laglab.runs.processes.sides:station_side"
        stack.enter_context(started("controller", side, order, Queue()))
        if flooded:
            ports = Ports((_port(link), _port(watch)))
            stack.enter_context(started("flood", f"{__name__}:flood", ports, Queue()))
        around = Surroundings(
            Listener(link, robot.codec.receiver),
            FileRecorder(Path(folder)),
            Patience(silence=PATIENT),
            robot.watch([watch]),
        )
        timing = whole(serve_alone(robot, around, stack)).timing
    assert timing is not None, "it was paced by the clock"
    return timing


def _port(endpoint: Endpoint) -> int:
    port = urlsplit(endpoint.name).port
    assert port is not None, "the system has given it one"
    return port


def flood(order: Ports, _: Tell) -> None:
    """Garbage, frames of others, requests and bad signatures, until the process is ended."""
    kinds: Sequence[Strangers] = get_args(Strangers)
    said = [data for who in kinds if who != "an impostor" for data in datagrams(who)]
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ours:
        for data, port in itertools.cycle(itertools.product(said, order.ports)):
            with suppress(OSError):  # nobody listens any more
                ours.sendto(data, ("127.0.0.1", port))
