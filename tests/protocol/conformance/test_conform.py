"""The kit passes what keeps the rules, and finds each fault: its own item, and no other."""

import re
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from xml.etree import ElementTree

import pytest

from laglab_conformance import Mark, Pace, Report, Waits, conform, controller, freerunning, lockstep
from laglab_conformance.ending import GIVES_UP
from laglab_conformance.items import Item, carry_out
from laglab_protocol import make_key, open_endpoint

from .faults import CONTROLLER, FREE_RUNNING, ROBOT, SIGNED
from .free_running_robots import FreeRunningRobot
from .reference_controller import Controller
from .reference_robots import Robot

QUICK = Waits(appear=3.0, react=1.0, refuse=0.1)

NOT_ALONE = {
    "it begins when a station is heard",
    "it calls until the robot is heard",
    "an ordinary frame is taken",
}
"""A peer that fails one of these can pass no other."""


def robot_with(
    fault: str, key_file: Path | None = None, pace: Pace = "lockstep", waits: Waits = QUICK
) -> Report:
    kind = Robot if pace == "lockstep" else FreeRunningRobot
    with open_endpoint("udpin://127.0.0.1:0") as endpoint, kind(endpoint, fault, key_file):
        return conform(endpoint.name.replace("udpin", "udpout"), "robot", key_file, waits, pace)


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


@pytest.mark.slow
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


def test_a_robot_that_tells_of_motion_the_other_way_round_is_found_out() -> None:
    """Of its commands nothing is seen to come into force: other items may fail, too."""
    report = robot_with("tells of motion backwards")
    assert "measurements tell the command in force" in report.failed
    assert "moves, though nobody commanded it" in report.table()


@pytest.mark.slow
def test_a_robot_with_a_habit_that_breaks_no_rule_conforms() -> None:
    """Its ticks come many at once, or seldom while nobody commands it; its speeds are rounded."""
    habits = ["bursts", "dozes", "counts in single precision"]
    with ThreadPoolExecutor(3) as pool:
        reports = list(pool.map(partial(robot_with, pace="realtime"), habits))

    assert [report.failed for report in reports] == [[], [], []]
    for report in reports:
        skipped = {each.group for each in report.results if each.mark is Mark.SKIPPED}
        assert skipped == {"signing"}


@pytest.mark.slow
def test_a_robot_behind_a_long_delay_conforms_when_it_is_waited_for() -> None:
    late = partial(robot_with, "is late", None, "realtime")
    hurried = late(QUICK._replace(react=0.1))

    assert not hurried.conforms
    assert "within 0.1 s" in hurried.table()
    assert late(QUICK).failed == []


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


def test_a_robot_that_measures_nothing_is_told_so() -> None:
    report = robot_with("measures nothing")
    assert len(report.results) == len(lockstep.ITEMS)
    assert "no measurement came" in report.table()
    assert not report.conforms


def test_what_the_kit_makes_nothing_of_fails_its_item_alone() -> None:
    def strange(_: object) -> str | None:
        raise OverflowError("4294967296 is no tick")

    items: list[Item[Any]] = [Item("ticks", "first", lambda _: None), Item("ticks", "odd", strange)]
    peer: Any = SimpleNamespace(ended=None)
    found = carry_out([*items, Item("ticks", "last", lambda _: None)], peer, print)
    assert [each.mark for each in found] == [Mark.PASSED, Mark.FAILED, Mark.PASSED]
    assert "4294967296 is no tick" in found[1].reason


def test_a_command_before_its_estimate_is_no_answer_with_one() -> None:
    report = controller_with("commands first")
    assert len(report.results) == len(controller.ITEMS)
    assert "the command tells of 1 estimates, 0 came" in report.table()


@pytest.mark.slow
def test_a_robot_is_not_left_in_silence_by_long_waits() -> None:
    """It would rightly give us up."""
    assert robot_with("", waits=QUICK._replace(react=4.0)).failed == []


def test_the_port_that_the_system_chose_is_told() -> None:
    steps: list[str] = []
    waits = Waits(0.2, 0.02, 0.02)
    conform("udpin://127.0.0.1:0", "controller", None, waits, progress=steps.append)
    assert re.fullmatch(r"testing the controller at udpin://127\.0\.0\.1:[1-9]\d+", steps[0])


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


@pytest.mark.parametrize(("fault", "failed"), [("", []), ("never gives up", [GIVES_UP.name])])
def test_a_robot_with_one_run_is_left_in_silence_instead_of_ended(
    fault: str, failed: list[str]
) -> None:
    with open_endpoint("udpin://127.0.0.1:0") as endpoint, Robot(endpoint, fault, None):
        url = endpoint.name.replace("udpin", "udpout")
        report = conform(url, "robot", None, QUICK._replace(react=0.5), scope="silence")

    assert report.failed == failed
    assert [each.name for each in report.results] == [item.name for item in lockstep.GIVING_UP]


def test_a_false_start_that_costs_a_frame_is_optional() -> None:
    report = robot_with("chokes on a false start")

    assert report.failed == ["a false start before a frame costs nothing"]
    assert report.conforms


def test_an_optional_item_does_not_decide() -> None:
    report = robot_with("does not answer pings")

    assert report.failed == ["it answers a ping"]
    assert report.conforms
