"""The kit passes what keeps the rules, and finds each fault: its own item, and no other."""

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from laglab_conformance import Pace, Report, Waits, conform, controller, freerunning, lockstep
from laglab_conformance.items import Item
from laglab_protocol import make_key, open_endpoint

from .reference_peers import Controller, FreeRunningRobot, Robot

QUICK = Waits(appear=3.0, react=1.0, refuse=0.1)

BOTH = {
    "compares half of the CRC": "a corrupted frame is refused",
    "knows no CRC_EXTRA": "another definition of the message is refused",
    "takes any incompatibility flag": "unknown incompatibility flags are refused",
    "refuses compatibility flags": "unknown compatibility flags are taken",
    "refuses untrimmed payloads": "untrimmed payloads are taken",
    "refuses longer payloads": "longer payloads of later versions are taken",
    "half a frame eats the next": "a frame cut short does not eat the next",
    "chokes on garbage": "garbage before a frame costs nothing",
    "chokes on a false start": "a false start before a frame costs nothing",
    "chokes on MAVLink 1": "MAVLink 1 does no harm",
    "chokes on unknown messages": "an unknown message is passed over",
    "obeys anybody": "another system is not obeyed",
    "obeys any component": "another component of the system is not obeyed",
    "sends stray bytes": "it sends nothing but frames",
    "skips numbers": "it numbers its frames one by one",
    "sends zeros": "it leaves trailing zeros at home",
    "keeps its settings to itself": "it tells its settings",
}
SIGNED = {
    "believes the unsigned": "unsigned frames are refused",
    "believes any signature": "frames signed with another key are refused",
    "believes old frames": "old timestamps are refused",
    "signs not all": "it signs what it sends",
}
ROBOT = BOTH | {
    "never repeats": "an unanswered tick is repeated",
    "measures again for a repeat": "a repeat brings the same messages",
    "miscounts measurements": "the tick counts its measurements",
    "moves by itself": "measurements tell the command in force",
    "goes back to earlier commands": "a later measurement tells of no earlier command",
    "leaves ticks out": "it goes from tick to tick",
    "takes later commands": "a command for a later tick is no answer",
    "takes earlier commands": "a command for an earlier tick is no answer",
    "does not wait for estimates": "an answer waits for its estimate",
    "stumbles over NaN": "it survives a command that is not finite",
    "is slow": "it goes on within 0.25 s",
    "accepts any command": "an unknown command is acknowledged as such",
    "does not report 0": "it reports Heartbeat on request",
    "does not report 148": "it reports AutopilotVersion on request",
    "loses parameters": "it lists its parameters",
    "mixes names up": "it reads a parameter by index and name",
    "does not answer pings": "it answers a ping",
    "forgets": "it recalls what was in force",
    "recalls amiss": "it recalls what was in force",
    "takes any target": "a command for another robot is not followed",
    "ignores END": "it answers END",
    "goes on after END": "it answers END",
    "gives another reason": "it answers END",
}
LOCKSTEP_ALONE = {
    "never repeats",
    "measures again for a repeat",
    "goes back to earlier commands",
    "leaves ticks out",
    "takes later commands",
    "takes earlier commands",
    "does not wait for estimates",
    "is slow",
}
FREE_RUNNING = {fault: item for fault, item in ROBOT.items() if fault not in LOCKSTEP_ALONE} | {
    "waits for its first command": "it waits for no answer",
    "tires": "its ticks come evenly",
    "follows older commands": "a command that is older than the newest is not followed",
    "repeats ticks": "each tick comes once",
    "leaves ticks out": "each tick comes once",
}
CONTROLLER = BOTH | {
    "stamps estimates wrong": "an answer is whole and stamped",
    "answers a repeat anew": "a repeated tick gets the same answer",
    "answers twice": "a tick is answered once",
    "does not count measurements": "a tick whose measurement is missing gets no answer",
    "goes back in time": "time does not go back",
    "aims elsewhere": "commands are meant for the robot",
    "does not ask": "it asks for what it missed",
    "commands infinity": "commands are finite",
    "is slow": "it answers within 0.25 s",
    "says END twice": "it answers END once",
    "ignores END": "it answers END once",
    "gives another reason": "it answers END once",
}
NOT_ALONE = {
    "it begins when a station is heard",
    "it calls until the robot is heard",
    "an ordinary frame is taken",
}
"""A peer that fails one of these can pass no other."""


def robot_with(fault: str, key_file: Path | None = None, pace: Pace = "lockstep") -> Report:
    kind = Robot if pace == "lockstep" else FreeRunningRobot
    with open_endpoint("udpin://127.0.0.1:0") as endpoint, kind(endpoint, fault, key_file):
        return conform(endpoint.name.replace("udpin", "udpout"), "robot", key_file, QUICK, pace)


def controller_with(fault: str, key_file: Path | None = None) -> Report:
    with open_endpoint("udpin://127.0.0.1:0") as free:
        url = free.name
    with (
        open_endpoint(url.replace("udpin", "udpout")) as endpoint,
        Controller(endpoint, fault, key_file),
    ):
        return conform(url, "controller", key_file, QUICK)


def others(items: Sequence[Item[Any]]) -> set[str]:
    return {item.name for item in items} - NOT_ALONE


@pytest.fixture
def key_file(tmp_path: Path) -> Path:
    make_key(tmp_path / "key")
    return tmp_path / "key"


def test_a_faultless_robot_conforms(key_file: Path) -> None:
    assert robot_with("").failed == []
    assert robot_with("", key_file).failed == []


def test_a_faultless_free_running_robot_conforms(key_file: Path) -> None:
    assert robot_with("", None, "realtime").failed == []
    assert robot_with("", key_file, "realtime").failed == []


def test_a_faultless_controller_conforms(key_file: Path) -> None:
    assert controller_with("").failed == []
    assert controller_with("", key_file).failed == []


def failed_of(test: Callable[[str], Report], faults: Iterable[str]) -> dict[str, list[str]]:
    """The items that each of these peers fails; several at once, for they wait most of the time."""
    with ThreadPoolExecutor(8) as pool:
        return dict(zip(faults, (each.failed for each in pool.map(test, faults)), strict=True))


def its_own_alone(faults: dict[str, str]) -> dict[str, list[str]]:
    return {fault: [item] for fault, item in faults.items()}


@pytest.mark.slow
def test_a_broken_robot_fails_its_own_item_alone() -> None:
    assert failed_of(robot_with, ROBOT) == its_own_alone(ROBOT)


@pytest.mark.slow
def test_a_broken_free_running_robot_fails_its_own_item_alone() -> None:
    test = partial(robot_with, pace="realtime")
    assert failed_of(test, FREE_RUNNING) == its_own_alone(FREE_RUNNING)


@pytest.mark.slow
def test_a_broken_controller_fails_its_own_item_alone() -> None:
    assert failed_of(controller_with, CONTROLLER) == its_own_alone(CONTROLLER)


@pytest.mark.slow
@pytest.mark.parametrize("test", [robot_with, controller_with])
def test_a_trusting_peer_fails_its_own_item_alone(
    test: Callable[[str, Path], Report], tmp_path: Path
) -> None:
    def with_its_own_key(fault: str) -> Report:
        make_key(tmp_path / fault)
        return test(fault, tmp_path / fault)

    assert failed_of(with_its_own_key, SIGNED) == its_own_alone(SIGNED)


def test_every_item_has_a_peer_that_fails_it() -> None:
    assert others(lockstep.ITEMS) == {*ROBOT.values(), *SIGNED.values()}
    assert others(freerunning.ITEMS) == {*FREE_RUNNING.values(), *SIGNED.values()}
    assert others(controller.ITEMS) == {*CONTROLLER.values(), *SIGNED.values()}


def test_a_robot_with_a_clock_of_its_own_is_told_from_one_that_breaks_the_lock_step() -> None:
    with open_endpoint("udpin://127.0.0.1:0") as endpoint, FreeRunningRobot(endpoint, "", None):
        report = conform(endpoint.name.replace("udpin", "udpout"), "robot", None, QUICK)

    assert not report.conforms
    assert "--pace realtime" in report.table()


def test_nobody_there_is_said() -> None:
    with open_endpoint("udpin://127.0.0.1:0") as free:
        url = free.name.replace("udpin", "udpout")
    report = conform(url, "robot", None, Waits(0.2, 0.02, 0.02))

    assert not report.conforms
    assert "no LAGLAB_TICK" in report.results[0].reason


def test_the_report_reads_as_a_table_and_as_junit() -> None:
    report = robot_with("compares half of the CRC")
    suite = ElementTree.fromstring(report.junit())

    assert not report.conforms
    assert "a corrupted frame is refused" in report.table()
    assert "the robot does not conform" in report.table()
    assert suite.get("failures") == "1"
    assert len(suite.findall("testcase")) == len(lockstep.ITEMS)
    assert [case.get("name") for case in suite if case.find("failure") is not None] == [
        "a corrupted frame is refused"
    ]


def test_an_optional_item_does_not_decide() -> None:
    report = robot_with("does not answer pings")

    assert report.failed == ["it answers a ping"]
    assert report.conforms
