"""The benchmark of a study, and what it is held against."""

from pathlib import Path

import msgspec
import numpy as np
import pytest

from laglab.bench import Report
from laglab.bench import study as bench
from laglab.bench.by_hand import Situation, many_by_hand
from laglab.command import main
from laglab.results.numbers import at_goal
from laglab.runs.station_side import station_config
from laglab.scenario import load


def test_the_loop_by_hand_brings_its_robots_to_the_goal() -> None:
    lab = load("lab", {"estimator.initial_covariance": 1e-4})
    config = station_config(lab)
    situation = Situation(config, 10, 20, ticks=1200)
    starts = np.tile(lab.start, (5, 1))
    ends = many_by_hand(starts, 1e-4, situation)
    assert at_goal(ends, lab.goal).all()
    assert len(np.unique(ends[:, 0])) == 5
    late = many_by_hand(starts, 1e-4, situation._replace(ticks=10))
    assert late == pytest.approx(starts, abs=0.05)  # no command is in force yet


def test_every_way_is_timed_with_both_filters(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    written = tmp_path / "study.json"
    few = ["--robots", "3", "--ticks", "30", "--rounds", "1"]
    with pytest.raises(SystemExit) as ended:
        main(["bench", "study", *few, "--json", str(written)])
    assert ended.value.code == 0
    report = msgspec.json.decode(written.read_bytes(), type=Report)
    result, by_two = report.results
    assert [t.name for t in by_two.timings] == ["1", "2"]
    ways = {bench.AT_ONCE, bench.GUARDED, bench.ALONE, bench.PLAIN}
    for kind, more in (("delayed-ekf", {bench.BY_HAND}), ("popf", set())):
        assert {t.name for t in result.timings if t.case == f"{kind} 10/20"} == ways | more
    assert len(report.figures) == 7
    page = capsys.readouterr().out
    assert max(map(len, page.splitlines())) <= 80
    assert "…" not in page
