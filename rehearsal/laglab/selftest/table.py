"""The kit on one robot after another that differ in who reads their frames, and the table."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from typing import NamedTuple

from laglab.selftest.libmav_receiver import LibmavReceiver
from laglab.selftest.receivers import CReceiver, PymavlinkReceiver
from laglab_conformance import Report, Waits, conform
from laglab_fmu import BuildError, CompilerNotFoundError
from laglab_gateway import (
    Gateway,
    GatewayConfig,
    Patience,
    Reading,
    Surroundings,
    serve_lockstep,
)
from laglab_protocol import Listener, Receiver, open_endpoint

MakeReceiver = Callable[[ExitStack], Receiver]

PARSERS: dict[str, MakeReceiver] = {
    "ours": lambda _: Receiver(),
    "pymavlink": PymavlinkReceiver,
    "mavgen's C": CReceiver,
    "libmav": LibmavReceiver,
}
WAITS = Waits(appear=5.0, react=2.0, refuse=0.15)


class Standing:
    """A plant that does not move."""

    def read(self) -> Reading:
        return Reading(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

    def step(self, v: float, omega: float) -> None:
        """It stays."""

    def place(self, x: float, y: float, theta: float) -> None:
        """It stays."""


class SelfTest(NamedTuple):
    """What each parser passes, and why some were not tried."""

    reports: dict[str, Report]
    missing: dict[str, str]

    def table(self) -> str:
        """A line for each item, a column for each parser; below, a line for each missing."""
        names = list(self.reports)
        lines = [_line("", names)]
        for row in zip(*(report.results for report in self.reports.values()), strict=True):
            named = f"{row[0].group:10}  {row[0].name}"
            named += "" if row[0].mandatory else " (optional)"
            lines.append(_line(named, [each.mark.value for each in row]))
        return "\n".join([*lines, *(f"{name}: {why}" for name, why in self.missing.items())])


def _line(name: str, cells: list[str]) -> str:
    return (f"{name:66}" + "".join(f"  {cell:10}" for cell in cells)).rstrip()


def self_test() -> SelfTest:
    """The kit on a robot that stands still in lock-step, by each parser that is there."""
    with ThreadPoolExecutor(len(PARSERS)) as pool:
        found = dict(zip(PARSERS, pool.map(_tried, PARSERS.values()), strict=True))
    return SelfTest(
        {name: each for name, each in found.items() if isinstance(each, Report)},
        {name: each for name, each in found.items() if isinstance(each, str)},
    )


def _tried(make: MakeReceiver) -> Report | str:
    """The kit's report, or why there is none."""
    with ExitStack() as stack:
        try:
            receiver = make(stack)
        except ModuleNotFoundError:
            return "not installed here: pip install 'laglab[conform]' brings it"
        except (BuildError, CompilerNotFoundError) as error:
            return str(error)
        return _report(receiver)


def _report(receiver: Receiver) -> Report:
    with open_endpoint("udpin://127.0.0.1:0") as endpoint, ThreadPoolExecutor(1) as robot:
        gateway = Gateway(Standing(), GatewayConfig(0, 0, None, 0.01))
        patience = Patience(repeat_after=0.03, connect=WAITS.appear)
        around = Surroundings(Listener(endpoint, receiver), patience=patience)
        served = robot.submit(serve_lockstep, gateway, around)
        url = endpoint.name.replace("udpin", "udpout")
        report = conform(url, "robot", waits=WAITS, scope="reading")
        served.result()
    return report
