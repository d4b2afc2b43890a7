"""Names in figures: long ones, many, and those that look like formulas."""

from io import BytesIO

import pytest

import laglab
from laglab.results.figures import INCHES, Width, legend, printed, sheet

WIDTHS: tuple[Width, ...] = ("one", "two")
LONG = "a_module_with_a_long_name:AnEstimatorWithAVeryLongNameIndeed"


@pytest.mark.parametrize("width", WIDTHS)
def test_long_names_leave_room_for_what_they_name(width: Width) -> None:
    """matplotlib warns, which is an error here, where there is none."""
    with printed():
        figure = sheet(INCHES[width], 1.0)
        for axes in figure.subplots(1, 3):
            axes.plot([0, 1], label=LONG)
            axes.plot([1, 0], label=f"{LONG}Too")
        legend(figure.axes[0])
        figure.savefig(BytesIO())
    named = figure.axes[0].get_legend()
    assert named is not None
    assert [text.get_text() for text in named.get_texts()] == [
        "…" + LONG[-25:],
        "…" + f"{LONG}Too"[-25:],
    ]


@pytest.mark.parametrize("width", WIDTHS)
def test_many_shadows_are_named_across_their_panels(width: Width) -> None:
    beside = ["popf-printed", "calibrating-ekf", "tue-predictor"]
    run = laglab.run("fig8", {"duration": 0.5, "estimator.compare": beside})
    with printed():
        run.figure(width=width).savefig(BytesIO())


@pytest.mark.parametrize("name", ["$x^2_$", "costs $5_ or $6", "a\\$b", "日本語"])
def test_a_name_is_no_formula(name: str) -> None:
    """Nor does anybody hear of a letter that the font lacks."""
    with printed():
        figure = laglab.run("fig6", {"duration": 0.3, "name": name}).figure()
        figure.savefig(BytesIO())
    title = figure.texts[0]
    assert title.get_text().startswith(f"{name}: ")
    assert not title.get_parse_math()


def test_powers_of_ten_are() -> None:
    with printed():
        figure = sheet(3.0, 2.0)
        axes = figure.subplots()
        axes.semilogy([1e-3, 1e3])
        figure.savefig(BytesIO())
    assert all(text.get_parse_math() for text in axes.get_yticklabels())
    assert not any(text.get_parse_math() for text in axes.get_xticklabels())
