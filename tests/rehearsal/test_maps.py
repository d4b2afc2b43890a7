"""`laglab map`: what is drawn is what is in the table, and can be seen by everybody."""

from itertools import product
from pathlib import Path

import numpy as np
import pandas
import pytest
from matplotlib import colormaps

from laglab.command import main
from laglab.errors import StudyError
from laglab.scenario import load
from laglab.studies.maps import draw_study, read_runs, runs_of
from laglab.studies.maps.drawing import margins
from laglab.studies.maps.grid import fields, sorted_into
from laglab.studies.maps.margin import excess
from laglab.studies.maps.measures import MeasureValues, median, share
from laglab.studies.maps.runs import Layout, layout
from laglab.studies.sweep.folder import Folder
from laglab.studies.sweep.study import Study

N, M, KIND = "link.command_delay", "link.measurement_delay", "estimator.kind"
GRID = {N: [0, 10, 20], M: [0, 20], KIND: ["raw", "popf"]}
SEEDS = range(1, 5)


def row(point: dict[str, object], seed: int) -> dict[str, object]:
    """Runs of raw diverge when n + m is 20 or more, but for seed 1."""
    late = point.get(N, 0) + point.get(M, 0) >= 20
    bad = point.get(KIND, "raw") == "raw" and late and seed > 1
    return {
        **point,
        "seed": seed,
        "converged": not bad,
        "settled_s": None if bad else 3.0 + seed,
        "rms_x": 1e4 if bad else 0.001 * seed,
        "diverged_tick": 300 if bad else None,
    }


def table(grid: dict[str, list[object]]) -> pandas.DataFrame:
    points = [dict(zip(grid, values, strict=True)) for values in product(*grid.values())]
    return pandas.DataFrame([row(point, seed) for point in points for seed in SEEDS])


def study(grid: dict[str, list[object]] = GRID, base: str | None = "fig4"):
    return runs_of(table(grid), grid, "study", load(base) if base else None)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A study's, as a sweep leaves it."""
    grid = {key: tuple(values) for key, values in GRID.items()}
    study = Study(load("fig4"), SEEDS, grid, name="study")
    made = Folder.made(tmp_path / "study", study)
    for cell in study.cells():
        content = pandas.DataFrame([row(dict(cell.grid), seed) for seed in cell.seeds])
        content.astype({"diverged_tick": float}).to_parquet(made.file(cell))
    return made.path


def failed(*arguments: object) -> int:
    with pytest.raises(SystemExit) as ended:
        main([str(each) for each in arguments])
    return int(ended.value.code or 0)


def test_wilsons_interval_is_the_textbooks():
    assert share(8, 10) == pytest.approx((0.8, 0.4902, 0.9433), abs=1e-4)
    assert share(0, 10) == pytest.approx((0.0, 0.0, 0.2775), abs=1e-4)
    assert np.isnan(share(0, 0)).all()


def test_the_medians_interval_holds_it_as_often_as_it_says():
    rng = np.random.default_rng(1)
    drawn = [median(rng.exponential(size=50)) for _ in range(1000)]
    held = np.mean([low <= np.log(2) <= high for _, low, high in drawn])
    assert 0.94 < held < 0.98


def test_the_medians_interval_has_no_favourite_side():
    for count in (3, 20, 51):
        centre, low, high = median(np.arange(count))
        assert centre - low == high - centre


def test_a_cell_holds_its_own_runs():
    runs = study()
    into = sorted_into(runs, Layout(N, M, KIND, ()))
    assert (into.x, into.y, into.panels) == ([0, 10, 20], [0, 20], ["raw", "popf"])
    raw, popf = fields(MeasureValues.by(runs, "converged"), into)
    np.testing.assert_array_equal(raw.centre, [[1, 1, 0.25], [0.25, 0.25, 0.25]])
    np.testing.assert_array_equal(raw.diverged, 1 - raw.centre)
    assert (popf.centre == 1).all()


def test_a_diverged_run_has_no_part_in_a_median():
    runs = study()
    raw, popf = fields(MeasureValues.by(runs, "rms_x"), sorted_into(runs, Layout(N, M, KIND, ())))
    assert raw.centre[1, 0] == pytest.approx(1.0)  # mm, of seed 1 alone
    assert popf.centre[1, 0] == pytest.approx(2.5)


def test_the_longest_numeric_keys_span_the_map():
    grid = {KIND: ["raw", "ekf", "popf", "delayed-ekf"], M: [0, 1], N: [0, 1, 2]}
    assert layout(study(grid)) == Layout(N, M, KIND, ())
    assert layout(study(grid), x=KIND) == Layout(KIND, N, M, ())
    assert layout(study({**GRID, "law.h": [1.0, 2.0]})) == Layout(N, M, KIND, ("law.h",))


def test_a_key_without_a_scale_makes_panels_before_a_longer_one():
    grid = {KIND: ["raw", "popf"], "law.h": [1.0, 2.0, 3.0], N: [0, 1, 2], M: [0, 1, 2]}
    assert layout(study(grid), x="law.h", y=N) == Layout("law.h", N, KIND, (M,))
    assert layout(study(grid), panels=N) == Layout("law.h", M, N, (KIND,))


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"x": N, "panels": N}, "--x and --panels are both 'link.command_delay': take two keys"),
        ({"panels": "law.h"}, "--panels: 'law.h' is not a key of this study's grid: "),
        ({"panels": M}, "--panels: link.measurement_delay has 7 values, and 6 panels have room"),
    ],
)
def test_panels_that_cannot_be_are_told(asked: dict[str, str], said: str):
    with pytest.raises(StudyError, match=said):
        draw_study(study({N: [0, 1], M: list(range(7)), KIND: ["raw", "popf"]}), **asked)


def test_panels_alone_are_no_map():
    with pytest.raises(StudyError, match=f"--panels: beside {N} nothing was varied"):
        draw_study(study({N: [0, 1], KIND: ["raw"]}), panels=N)


def test_panels_are_those_that_are_asked_for(folder: Path):
    out, asked = folder / "map.png", ("--x", M, "--y", KIND, "--panels", N)
    assert failed("map", folder, *asked, "--value", "rms_x", "--out", out) == 0
    assert out.read_bytes().startswith(b"\x89PNG")
    figure = draw_study(read_runs(folder), ["rms_x"], x=M, y=KIND, panels=N)
    told = (axes.get_title() for axes in figure.axes)
    titles = [" ".join(title.split()) for title in told if title]
    assert titles == [f"command delay n [ticks] = {value}" for value in (0, 10, 20)]
    lines = draw_study(read_runs(folder), ["rms_x"], panels=N)
    assert [each.get_text() for each in lines.legends[0].get_texts()] == titles


def test_titles_of_panels_are_no_wider_than_these():
    grid = {N: [0, 1], "law.h": [1.0, 2.0], "link.measurement.extra_delay.mean": [0.01, 0.02]}
    figure = draw_study(study(grid), ["converged"], x=N, y="law.h")
    figure.draw_without_rendering()
    first, second = (axes.title.get_window_extent() for axes in figure.axes[:2])
    assert "\n" in figure.axes[0].get_title()
    assert not first.overlaps(second)


def test_what_is_taken_together_is_in_the_title():
    figure = draw_study(study({**GRID, "law.h": [1.0, 2.0]}), ["converged"], x=N, y=M)
    assert "together" in figure.get_suptitle()


def test_the_margin_goes_between_what_settles_and_what_does_not():
    """9 ticks by the paper's gains, whoever is late; at h = 3 it is 7."""
    over = excess(load("fig4"), N, np.array([0.0, 4.0, 9.0, 10.0]), M, np.array([0.0, 6.0]))
    assert (over.approach < 0).tolist() == [[True, True, True, False], [True, False, False, False]]
    assert np.isnan(over.hold).all()
    over = excess(load("fig4"), "law.h", np.array([1.0, 3.0]), N, np.array([7.0, 8.0]))
    assert (over.approach < 0).tolist() == [[True, True], [True, False]]
    assert excess(load("lab"), N, np.array([31.0, 32.0]), "x", np.zeros(1)).hold.tolist() == [
        [-0.5, 0.5]
    ]


def test_each_panel_has_the_margin_of_its_own_gains():
    runs = study({N: [0, 5, 10], M: [0, 5, 10], "law.h": [1.0, 3.0]})
    chosen = layout(runs)
    first, second = margins(runs, chosen, sorted_into(runs, chosen))
    assert (first.excess.approach < 0).sum() > (second.excess.approach < 0).sum() > 0


def test_where_a_cell_has_several_margins_none_is_drawn():
    runs = study({N: [0, 5, 10], KIND: ["raw", "popf"], M: [0, 5, 10]})
    chosen = Layout(N, KIND, None, (M,))
    assert margins(runs, chosen, sorted_into(runs, chosen)) == []


def test_the_scale_is_told_apart_without_colour():
    """Perceived lightness only rises, and black and white ink stand out on either half."""
    red, green, blue, _ = colormaps["cividis"](np.linspace(0, 1, 256)).T
    lightness = 0.2126 * red**2.2 + 0.7152 * green**2.2 + 0.0722 * blue**2.2
    assert (np.diff(lightness) > -1e-4).all()
    assert lightness[-1] > 10 * (lightness[0] + 0.01)


@pytest.mark.parametrize(
    ("name", "magic"), [("a.png", b"\x89PNG"), ("a.pdf", b"%PDF"), ("a.svg", b"<?xml")]
)
def test_the_command_draws_what_the_ending_says(folder, tmp_path, name, magic):
    out = tmp_path / name
    assert failed("map", folder, "--out", out) == 0
    assert out.read_bytes().startswith(magic)


def test_one_key_makes_lines_with_their_intervals():
    figure = draw_study(study({N: [0, 10, 20], KIND: ["raw", "popf"]}), ["converged", "settled_s"])
    shares, _ = figure.axes
    (legend,) = figure.legends
    assert len(shares.containers) == 2
    assert "raw" in [text.get_text() for text in legend.get_texts()]


def test_values_without_an_order_can_be_drawn_too():
    assert draw_study(study({KIND: ["raw", "popf"]}), ["converged"]).axes
    kinds = {KIND: ["raw", "popf"], "plant.integration": ["euler", "exact"]}
    assert draw_study(study(kinds), ["converged"], x=KIND, y="plant.integration").axes


def test_one_point_is_no_map():
    with pytest.raises(StudyError, match="no map to draw"):
        draw_study(study({N: [10]}))


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--value", "nonsense"), "there is no column 'nonsense'"),
        (("--value", KIND), "does not hold numbers"),
        (("--x", "nonsense"), "not a key of this study's grid"),
        (("--x", N, "--y", N), "take two keys"),
        (("--out", "map.nonsense"), "must end in one of"),
    ],
)
def test_what_cannot_be_drawn_is_one_line(folder, options, said, capsys):
    assert failed("map", folder, *options) == 2
    assert said in capsys.readouterr().err


def test_what_is_foreign_is_not_looked_at(folder, tmp_path):
    pandas.DataFrame({"a": [1]}).to_parquet(folder / "cells" / "foreign.parquet")
    assert failed("map", folder, "--out", tmp_path / "map.png") == 0


def test_a_folder_with_nothing_to_draw_is_one_line(folder, tmp_path, capsys):
    assert failed("map", tmp_path) == 2
    assert "study.toml cannot be read" in capsys.readouterr().err
    first, *others = (folder / "cells").iterdir()
    first.write_bytes(b"nonsense")
    assert failed("map", folder) == 2
    assert f"{first.name} cannot be read" in capsys.readouterr().err
    for file in (first, *others):
        file.unlink()
    assert failed("map", folder) == 2
    assert "no cell of this study has been computed" in capsys.readouterr().err


def test_a_cell_without_our_columns_is_one_line(folder, capsys):
    for file in (folder / "cells").iterdir():
        pandas.DataFrame({"a": [1]}).to_parquet(file)
    assert failed("map", folder) == 2
    assert "what is not a cell of this study: it has no column" in capsys.readouterr().err


def test_by_default_is_drawn_what_says_something():
    labels = [axes.get_ylabel() for axes in draw_study(study()).axes]
    assert any("diverged" in label for label in labels)
    healthy = study({N: [0, 10], M: [0, 5]})
    labels = [axes.get_ylabel() for axes in draw_study(healthy).axes]
    assert not any("diverged" in label for label in labels)
    assert any("settling" in label for label in labels)


def test_an_error_that_is_no_number_in_its_unit_warns_of_nothing() -> None:
    rows = pandas.DataFrame([{"seed": 1, "rms_x": 1.7e308, "diverged_tick": 300.0}])
    assert np.isinf(MeasureValues.by(runs_of(rows, {}, "study", None), "rms_x").values).all()
