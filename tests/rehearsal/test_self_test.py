"""The kit on robots that read by other people's parsers."""

import sys
from collections.abc import Callable

import pytest

from laglab.selftest import self_test, table

FALSE_START = "a false start before a frame costs nothing"
CUT_SHORT = "a frame cut short does not eat the next"
FAILED = {
    "ours": [],
    "pymavlink": [FALSE_START, CUT_SHORT],
    "mavgen's C": [FALSE_START, CUT_SHORT],
    "libmav": [
        "garbage before a frame costs nothing",
        FALSE_START,
        CUT_SHORT,
        "unknown incompatibility flags are refused",
        "MAVLink 1 does no harm",
    ],
}


@pytest.mark.slow
def test_each_parser_passes_what_it_is_known_to_pass() -> None:
    tested = self_test()

    assert tested.missing == {}
    assert {name: report.failed for name, report in tested.reports.items()} == FAILED
    head, *rows = tested.table().splitlines()
    assert head.split(maxsplit=1) == ["ours", "pymavlink   mavgen's C  libmav"]
    (row,) = [each for each in rows if FALSE_START in each]
    assert row.split("(optional)")[1].split() == ["passed", "FAILED", "FAILED", "FAILED"]


def test_a_parser_that_is_not_installed_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "libmav", None)
    few = {name: table.PARSERS[name] for name in ("ours", "libmav")}
    monkeypatch.setattr(table, "PARSERS", few)
    tested = self_test()

    assert list(tested.reports) == ["ours"]
    assert tested.table().splitlines()[-1].startswith("libmav: not installed here: pip install")


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (("udpout://127.0.0.1:9", "--self-test"), "say nothing else with it"),
        (("--self-test", "--side", "robot"), "say nothing else with it"),
        (("--self-test", "--pace", "realtime"), "say nothing else with it"),
        (("--self-test", "--wait", "9"), "say nothing else with it"),
        (("--self-test", "--silent"), "say nothing else with it"),
        (("--side", "robot"), "say where the other side answers"),
        (("udpout://127.0.0.1:9",), "say where the other side answers"),
    ],
)
def test_what_is_tested_is_said_once(
    refused: Callable[..., str], arguments: tuple[str, ...], why: str
) -> None:
    assert why in refused("conform", *arguments)
