"""The benchmark of a flood runs the loop with strangers and without."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import msgspec
import pytest

from laglab.bench import Report


@pytest.mark.slow
def test_the_benchmark_says_what_a_flood_costs(
    tmp_path: Path, laglab: Callable[..., subprocess.CompletedProcess[str]]
) -> None:
    result = laglab("bench", "flood", "--rounds", "1", "--seconds", "2", "--json", "flood.json")
    assert result.returncode == 0, result.stderr
    report = msgspec.json.decode((tmp_path / "flood.json").read_bytes(), type=Report)
    assert [each.name for each in report.results[0].timings] == ["nobody else", "a flood"]
    assert all(each.fastest > 0 for each in report.results[0].timings)
    assert [each.name for each in report.figures] == [
        "deadlines missed: nobody else",
        "deadlines missed: a flood",
    ]
    assert all(0 <= each.value <= 100 for each in report.figures)
