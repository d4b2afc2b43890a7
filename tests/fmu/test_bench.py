"""The benchmark runs and compares what it says; its numbers are for people."""

import tempfile
from pathlib import Path

import pytest

from laglab.bench.fmu import PLAIN, bench


def test_every_way_is_measured(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    rows = {row.name: row for row in bench(robots=20, ticks=50, repeats=2)}
    assert set(rows) == {
        *(f"FMI {v}, our stepper" for v in (2, 3)),
        *(f"FMI {v}, FMPy's slave methods" for v in (2, 3)),
        *(f"FMI {v}, simulate_fmu" for v in (2, 3)),
        "FMI 3, fleet of 20",
        PLAIN,
    }
    assert rows[PLAIN].ratio == 1.0
    for row in rows.values():
        assert row.seconds > 0
        assert row.ratio == pytest.approx(row.seconds / rows[PLAIN].seconds)
    assert not list(tmp_path.iterdir())
