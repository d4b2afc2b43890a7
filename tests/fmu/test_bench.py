"""The benchmark runs and compares what it says; its numbers are for people."""

import tempfile
from contextlib import ExitStack
from pathlib import Path

import pytest

from laglab.bench import run
from laglab.bench.fmu import PLAIN, bench


def test_every_way_is_measured(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    with ExitStack() as stack:
        report = run(bench(20, 50, stack), 2, lambda _: None)
    ratios = {timing.name: timing.ratio for timing in report.results[0].timings}
    assert set(ratios) == {
        *(f"FMI {v}, our stepper" for v in (2, 3)),
        *(f"FMI {v}, FMPy's slave methods" for v in (2, 3)),
        *(f"FMI {v}, simulate_fmu" for v in (2, 3)),
        "FMI 3, fleet of 20",
        PLAIN,
    }
    assert ratios[PLAIN] == 1.0
    assert [figure.name for figure in report.figures] == [
        f"FMI {v}: FMPy's slave methods to our stepper" for v in (2, 3)
    ]
    assert report.figures[0].value == pytest.approx(
        ratios["FMI 2, FMPy's slave methods"] / ratios["FMI 2, our stepper"]
    )
    assert not list(tmp_path.iterdir())
