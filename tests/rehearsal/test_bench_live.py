"""The benchmark of the live page tries it with nobody there, with readers, and with idle ones."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import msgspec
import pytest

from laglab.bench import Report


@pytest.mark.slow
def test_the_benchmark_says_what_a_page_costs(
    tmp_path: Path, laglab: Callable[..., subprocess.CompletedProcess[str]]
) -> None:
    result = laglab("bench", "live", "--rounds", "1", "--seconds", "1", "--json", "live.json")
    assert result.returncode == 0, result.stderr
    report = msgspec.json.decode((tmp_path / "live.json").read_bytes(), type=Report)
    assert [each.name for each in report.results[0].timings] == [
        "no page",
        "a page",
        "100 readers",
        "100 that stall",
    ]
    assert all(each.fastest > 0 for each in report.results[0].timings)
    assert len(report.figures) == 3
    assert all(each.value > 0 for each in report.figures)
