"""The harness of all benches; and of ``laglab bench filter``, that it times what it says."""

import itertools
from io import StringIO
from pathlib import Path

import msgspec
import pytest
from rich.console import Console

import laglab as package
from laglab.bench import Bench, Contest, Figure, Report, Turn, Unit, run, show, timed
from laglab.bench import filter as filter_bench
from laglab.bench.table import significant
from laglab.command import main
from laglab.files import json_of


def quiet(_: str) -> None:
    """Nobody looks on."""


def turn_of(name: str, seconds: list[float], log: list[str]) -> Turn:
    """Takes these seconds in one turn after the other, and says that it was its turn."""
    left = iter(seconds)

    def turn() -> float:
        log.append(name)
        return next(left)

    return turn


def made(log: list[str]) -> Bench:
    """Two cases of two contenders, enough for three rounds."""
    cases = {
        "near": {
            "ours": turn_of("near ours", [3.0, 2.0, 9.0], log),
            "theirs": turn_of("near theirs", [4.0, 40.0, 8.0], log),
        },
        "far": {
            "ours": turn_of("far ours", [0.5, 0.5, 0.5], log),
            "theirs": turn_of("far theirs", [0.25, 1.0, 1.0], log),
        },
    }
    contest = Contest("a walk", Unit("ms a step", 1e-3), "ours", cases)
    return Bench("walk", [contest], lambda results, _: [Figure("walks", len(results), "")])


def test_the_fastest_turn_counts_and_the_median_is_told() -> None:
    (result,) = run(made([]), 3, quiet).results
    told = [(t.case, t.name, t.fastest, t.median, t.unit, t.ratio) for t in result.timings]
    assert told == [
        ("near", "ours", 2000.0, 3000.0, "ms a step", 1.0),
        ("near", "theirs", 4000.0, 8000.0, "ms a step", 2.0),
        ("far", "ours", 500.0, 500.0, "ms a step", 1.0),
        ("far", "theirs", 250.0, 1000.0, "ms a step", 0.5),
    ]
    assert result.fastest("far", "theirs") == 250.0


def test_contenders_take_turns_round_after_round() -> None:
    log: list[str] = []
    run(made(log), 3, quiet)
    assert log == 3 * ["near ours", "near theirs", "far ours", "far theirs"]


def test_a_timed_turn_tells_of_one_piece_of_its_work() -> None:
    calls = itertools.count()
    few, many = (timed(lambda: sum(range(20_000)) + next(calls), pieces) for pieces in (1, 10_000))
    assert 0 < many() < few()
    assert next(calls) == 2


def test_the_report_is_read_as_it_was_written() -> None:
    report = run(made([]), 3, quiet)
    assert msgspec.json.decode(json_of(report), type=Report) == report
    assert (report.schema, report.bench, report.rounds) == (1, "walk", 3)
    assert report.laglab == package.__version__
    assert report.machine.cpus >= 1


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0301234, "0.0301"), (1.0, "1.00"), (12.345, "12.3"), (1762.4, "1762"), (0, "0")],
)
def test_three_digits_count(value: float, text: str) -> None:
    assert significant(value) == text


def test_a_report_is_shown_whole_within_80_columns() -> None:
    page = StringIO()
    show(run(made([]), 3, quiet), Console(file=page, width=200))
    lines = page.getvalue().splitlines()
    assert max(map(len, lines)) <= 80
    assert [line.split() for line in lines if "ours  " in line or "theirs" in line] == [
        ["near", "ours", "2000", "3000", "1.00"],
        ["theirs", "4000", "8000", "2.00"],
        ["far", "ours", "500", "500", "1.00"],
        ["theirs", "250", "1000", "0.500"],
    ]
    assert ["walks", "1.00"] in [line.split() for line in lines]
    assert lines[-1].startswith("of 3 rounds the fastest; Python")


def test_every_filter_is_timed_at_every_delay_and_the_whole_controller_too(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    written = tmp_path / "filter.json"
    with pytest.raises(SystemExit) as ended:
        main(["bench", "filter", "--ticks", "10", "--rounds", "1", "--json", str(written)])
    assert ended.value.code == 0
    report = msgspec.json.decode(written.read_bytes(), type=Report)
    alone, whole = ({(t.case, t.name) for t in result.timings} for result in report.results)
    rivals = {"popf, product taken anew", "EKF rerun over window", filter_bench.FILTERPY}
    ours = set(filter_bench.OURS)
    assert alone == set(itertools.product(("m = 4", "m = 40", "m = 400"), ours | rivals))
    controllers = ours | {filter_bench.GUARDED}
    assert whole == set(itertools.product(("m = 2", "m = 20", "m = 200"), controllers))
    assert len(report.figures) == len(ours | rivals) + len(controllers)
    page = capsys.readouterr().out
    assert "the filter alone" in page
    assert "extrapolation over n = m ticks" in page
    assert max(map(len, page.splitlines())) <= 80
    assert "…" not in page


def test_a_file_that_cannot_be_written_is_refused_before_anything_is_measured(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["bench", "loop", "--json", str(tmp_path / "none" / "loop.json")])
    assert ended.value.code == 2
    assert "--json" in capsys.readouterr().err
