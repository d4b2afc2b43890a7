"""Figures fit a page, and show what they name."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import laglab
from laglab.errors import MissingExtraError
from laglab.results.figures import Width, draw_runs
from laglab.results.figures.style import MOST_HIGH
from laglab.results.numbers import robot_pose
from laglab.results.report import report_html

WIDTHS: tuple[Width, ...] = ("one", "two")


@pytest.fixture(scope="module")
def tracked() -> laglab.Run:
    return laglab.run("track-eight", {"duration": 4.0})


def panel(figure: Figure, name: str) -> Axes:
    (axes,) = (axes for axes in figure.axes if axes.get_label() == name)
    return axes


@pytest.mark.parametrize("width", WIDTHS)
def test_however_many_panels_a_figure_fits_a_page(width: Width, tracked: laglab.Run) -> None:
    run = laglab.run("lab-radio", {"duration": 4.0, "estimator.compare": ["popf", "ekf"]})
    for figure in (run.figure(width), draw_runs([run, tracked], width)):
        assert figure.get_size_inches()[1] <= MOST_HIGH


@pytest.mark.parametrize("width", WIDTHS)
def test_of_a_path_one_sees_where_it_leads_and_how_far_off_the_robot_is(
    width: Width, tracked: laglab.Run
) -> None:
    figure = tracked.figure(width)
    plane = {line.get_label(): line for line in panel(figure, "path").lines}
    assert plane["path"].get_linewidth() > 2 * plane["true"].get_linewidth(), "it lies beneath"
    assert plane["path"].get_zorder() < plane["true"].get_zorder()
    (distance,) = panel(figure, "distance").lines
    pose = robot_pose(tracked.trace)
    off = pose - tracked.scenario.target.poses(tracked.trace["tick"])
    drawn = np.asarray(distance.get_ydata())
    np.testing.assert_allclose(drawn, np.hypot(off[:, 0], off[:, 1]))


def test_a_title_too_long_ends_at_a_whole_key_kinds_first(tracked: laglab.Run) -> None:
    other = laglab.run("fig6", {"duration": 0.1})
    title = draw_runs([other, tracked], "one").get_suptitle()
    assert title.startswith('estimator.kind: "popf" | "delayed-ekf"; law.kind:'.replace(" ", " "))
    *told, last = " ".join(title.split()).split("; ")
    assert last.startswith("... (")
    assert last.endswith("keys differ)")
    assert all(": " in each and each.count('"') % 2 == 0 for each in told)


def test_a_summary_says_with_what_it_was_made(tmp_path: Path) -> None:
    made = laglab.run("fig6", {"duration": 0.1}, out=tmp_path / "run")
    assert made.summary.versions["numpy"] == np.__version__
    kept = laglab.open_run(tmp_path / "run").summary
    assert set(kept.versions) == {"Python", "numpy", "FMPy"}
    assert f"by laglab {kept.laglab}, Python " in report_html([made])


def test_without_pandas_it_is_said_what_brings_it(
    tracked: laglab.Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("laglab.extras.find_spec", lambda module: module != "pandas" or None)
    with pytest.raises(MissingExtraError, match=r"pip install 'laglab\[study\]'"):
        tracked.to_pandas()
