"""What the figures show, by their artists; not by their pixels."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.quiver import Quiver

import laglab
from laglab.results.columns import joined
from laglab.results.figures import INCHES, Width, draw_runs
from laglab.results.figures.strip import CAUSES
from laglab.results.link_view import link_view
from laglab.results.report import plots
from laglab.results.run import Kept
from laglab.scenario import load
from laglab.scenario.differences import differing
from laglab_gateway import ROWS
from laglab_gateway.drive import Rejection
from laglab_gateway.link.fates import FateKind

WIDTHS: tuple[Width, ...] = ("one", "two")
PUSHED = {"plant.event": [{"at": 3.0, "by": [0.5, 0.0, 0.0]}], "duration": 4.0}


@pytest.fixture(scope="module")
def radio() -> laglab.Run:
    return laglab.run("lab-radio", {"duration": 5.0})


@pytest.fixture(scope="module")
def shadowed() -> laglab.Run:
    return laglab.run("fig8", {"duration": 1.0, "estimator.compare": ["ekf", "delayed-ekf"]})


@pytest.fixture(scope="module")
def papers() -> list[laglab.Run]:
    return [laglab.run(name, {"duration": 2.0}) for name in ("fig5", "fig6")]


def panel(figure: Figure, name: str) -> Axes:
    (found,) = (axes for axes in figure.axes if axes.get_label() == name)
    return found


def names(axes: Axes) -> list[str]:
    legend = axes.get_legend()
    return [text.get_text() for text in legend.get_texts()] if legend else []


def line(axes: Axes, name: str) -> np.ndarray:
    (found,) = (each for each in axes.lines if each.get_label() == name)
    return np.asarray(found.get_xydata())


@pytest.mark.parametrize("width", WIDTHS)
def test_a_figure_is_as_wide_as_its_columns_and_its_letters_are_fit_for_print(
    radio: laglab.Run, width: Width
) -> None:
    figure = radio.figure(width)
    assert figure.get_figwidth() == INCHES[width]
    sizes = {text.get_fontsize() for axes in figure.axes for text in axes.get_xticklabels()}
    assert 6 <= min(sizes) <= max(sizes) <= 8
    assert all(each.get_linewidth() >= 0.4 for axes in figure.axes for each in axes.lines)


def test_the_path_has_truth_estimate_measurements_ends_and_headings(radio: laglab.Run) -> None:
    path = panel(radio.figure(), "path")
    assert set(names(path)) == {"measured", "true", "estimated", "start", "goal"}
    np.testing.assert_array_equal(line(path, "true")[:, 0], radio.trace["x"])
    (arrows,) = (each for each in path.collections if isinstance(each, Quiver))
    places = np.asarray(arrows.get_offsets())
    rows = [np.flatnonzero(radio.trace["x"] == x)[0] for x in places[:, 0]]
    np.testing.assert_allclose(np.asarray(arrows.U), np.cos(radio.trace["theta"][rows]))
    assert path.get_aspect() == 1.0


@pytest.mark.parametrize(("component", "variance"), [("x", "p_xx"), ("y", "p_yy"), ("θ", "p_tt")])
def test_errors_stand_between_two_sigma_of_what_is_claimed(
    radio: laglab.Run, component: str, variance: str
) -> None:
    axes = panel(radio.figure(), f"error {component}")
    (band,) = axes.collections[:1]
    reach = np.asarray(band.get_paths()[0].vertices)[:, 1].max()
    assert reach == pytest.approx(2 * np.sqrt(radio.claims[variance].max()))
    error = line(axes, "error")[:, 1]
    assert np.abs(error[~np.isnan(error)]).max() < axes.get_ylim()[1]


def test_speeds_have_axes_of_their_own_with_commands_sent_and_applied(radio: laglab.Run) -> None:
    figure = radio.figure()
    for name in ("v", "omega"):
        axes = panel(figure, name)
        np.testing.assert_array_equal(line(axes, "applied")[:, 1], radio.trace[name])
        np.testing.assert_array_equal(line(axes, "sent")[:, 1], radio.trace[f"{name}_sent"])


def test_the_strip_of_lab_radio_shows_delays_losses_the_outage_and_the_stop(
    radio: laglab.Run,
) -> None:
    """Half a second of silence from t = 3 s on."""
    figure, link = radio.figure(), radio.summary.link
    assert link is not None
    for direction, audit in (("command", link.command), ("measurement", link.measurement)):
        axes = panel(figure, direction)
        dots = np.asarray(axes.lines[0].get_xydata())
        assert len(dots) == audit.arrived
        assert audit.measured is not None
        assert dots[:, 1].max() == audit.measured.max < axes.get_ylim()[1]
        said = names(axes)
        assert {f"{cause}: {count}" for cause, count in audit.lost.items() if count} <= set(said)
        assert "outage" in said
    assert "robot stops by itself" in names(panel(figure, "command"))
    view = link_view(radio)
    for direction in view.directions.values():
        (outage,) = (span for span in direction.outages if span.end - span.start > 0.4)
        assert outage == pytest.approx((3.0, 3.5), abs=0.05)
    (stop,) = view.stopped
    assert round(stop.start * 100) == link.failsafe_stops[0]
    assert stop.start < stop.end < 5.0


def test_an_announced_outage_is_one_however_short() -> None:
    """And where a few frames in a row are lost otherwise, that is none."""
    lossy = {"link.command.outages": [[0.5, 0.05]], "link.measurement.loss": 0.7, "duration": 1.0}
    view = link_view(laglab.run("lab", lossy))
    (outage,) = view.directions["command"].outages
    assert outage == pytest.approx((0.5, 0.55))
    assert view.directions["measurement"].outages == []
    assert len(view.directions["measurement"].lost["lost"]) > 50


def test_an_alarm_is_marked_when_it_was_raised() -> None:
    run = laglab.run("lab", PUSHED)
    (tick,) = run.alarms
    for axes in run.figure().axes[1:]:
        marks = [each for each in axes.lines if each.get_label() == "alarm"]
        assert [each.get_xdata()[0] for each in marks] == [pytest.approx(tick * 0.01)]


def test_an_alarm_is_named_and_none_of_the_curves() -> None:
    figure = laglab.run("lab", {**PUSHED, "estimator.compare": ["ekf"]}).figure()
    for name in ("error x", "shadow x"):
        axes = panel(figure, name)
        assert "alarm" in names(axes)
        (alarm,) = (each for each in axes.lines if each.get_label() == "alarm")
        assert alarm.get_marker() == "v"


def unseen(run: laglab.Run) -> laglab.Run:
    """As of a real robot, whose true pose nobody knows."""
    nowhere = np.full(len(run.trace["tick"]), np.nan)
    trace = run.trace | dict.fromkeys(("x", "y", "theta"), nowhere)
    tables = {name: joined(run.table_pieces(name)) for name in ROWS}
    return laglab.Run(run.scenario, run.summary, None, Kept(trace, tables, {}))


def test_what_is_measured_is_not_called_true() -> None:
    run = laglab.run("lab", {"duration": 1.0})
    real = unseen(run)
    assert panel(real.figure(), "error x").get_ylabel().startswith("x less\nmeasured")
    figure = draw_runs([run, real])
    assert names(panel(figure, "error")) == ["1: lab", "2: lab, less measured"]
    assert "2: lab, measured" in names(panel(figure, "path"))
    assert names(panel(draw_runs([run, run]), "error")) == []


def test_rounding_is_drawn_as_no_error() -> None:
    figure = laglab.run("fig6", {"duration": 2.0, "estimator.compare": ["delayed-ekf"]}).figure()
    figure.draw_without_rendering()
    for component in "xyθ":
        axes = panel(figure, f"shadow {component}")
        assert axes.yaxis.get_offset_text().get_text() == "", "it would lie over the legend"


@pytest.mark.parametrize("width", WIDTHS)
def test_shadows_come_beside_the_runs_own_panels(shadowed: laglab.Run, width: Width) -> None:
    figure = shadowed.figure(width)
    own = {each.get_label() for each in figure.axes}
    assert own >= {"path", "error x", "error θ", "v", "omega", "command", "measurement"}
    for component in "xyθ":
        axes = panel(figure, f"shadow {component}")
        looks = {
            each.get_label(): (each.get_linestyle(), each.get_marker()) for each in axes.lines[:3]
        }
        assert list(looks) == ["popf", "ekf", "delayed-ekf"]
        assert len(set(looks.values())) == 3


def test_without_an_estimate_the_pose_itself_is_drawn(papers: list[laglab.Run]) -> None:
    figure = papers[0].figure()
    np.testing.assert_array_equal(line(panel(figure, "θ"), "true")[:, 1], papers[0].trace["theta"])
    assert not any("error" in str(each.get_label()) for each in figure.axes)


@pytest.mark.parametrize("width", WIDTHS)
def test_runs_lie_over_each_other_on_equal_axes(papers: list[laglab.Run], width: Width) -> None:
    figure = draw_runs(papers, width)
    assert figure.get_suptitle().startswith('estimator.kind: "raw" | "popf"')
    for name in ("x [m]", "θ [rad]", "v", "command"):
        drawn = [str(each.get_label()) for each in panel(figure, name).lines]
        assert {"fig5", "fig6"} <= set(drawn)
    path = panel(figure, "path")
    looks = [(each.get_linestyle(), each.get_marker()) for each in path.lines[:2]]
    assert looks[0] != looks[1]


def test_what_scenarios_differ_in() -> None:
    lab = load("lab")
    assert differing([lab, lab]) == {}
    other = load("lab", {"link.command_delay": 3, "link.command.burst.good_to_bad": 0.1})
    found = differing([lab, other])
    assert found["link.command_delay"] == ["10", "3"]
    assert found["link.command.burst.good_to_bad"] == ["not set", "0.1"]
    assert not any(key.startswith("law") for key in found)


@pytest.mark.parametrize("ticks", [1, 2, 30])
def test_a_run_of_a_few_ticks_has_its_figure(ticks: int, tmp_path: Path) -> None:
    run = laglab.run("lab", {"duration": ticks * 0.01}, out=tmp_path / "run")
    assert (tmp_path / "run" / "figure.png").exists()
    texts = [text.get_text() for text in panel(run.figure(), "command").texts]
    assert ("none arrived" in texts) == (ticks < 10)


def test_a_long_run_shows_its_rarest_delay_and_loss(monkeypatch: pytest.MonkeyPatch) -> None:
    from laglab.results import run as results

    rare = {
        "link.measurement.extra_delay": {"distribution": "uniform", "mean": 0.02, "spread": 0.02}
    }
    rare_loss = {"link.command.loss": 0.004, "duration": 10.0, "estimator.guard": False}
    run = laglab.run("lab", {**rare, **rare_loss})
    assert run.summary.link is not None
    whole = link_view(run)
    monkeypatch.setattr(results, "MOST_DRAWN", 100)
    thinned = link_view(run)
    measured = run.summary.link.measurement.measured
    assert measured is not None
    seen = thinned.directions["measurement"]
    assert len(seen.time) < len(whole.directions["measurement"].time) / 4
    assert (seen.delay.min(), seen.delay.max()) == (measured.min, measured.max)
    assert len(thinned.directions["command"].lost["lost"]) >= 1
    assert thinned.directions["command"].counts["lost"] == run.summary.link.command.lost["lost"]
    run.figure()


def test_figure_draws_again_in_the_format_of_the_name(
    tmp_path: Path, ended: Callable[..., Any]
) -> None:
    laglab.run("lab", {"duration": 0.5}, out=tmp_path / "run")
    trace = (tmp_path / "run" / "trace.csv").read_bytes()
    for ending, begins in {"png": b"\x89PNG", "pdf": b"%PDF", "svg": b"<?xml"}.items():
        out = tmp_path / f"again.{ending}"
        done = ended("figure", tmp_path / "run", "--out", out, "--width", "one")
        assert (done.code, done.out.strip()) == (0, str(out))
        assert out.read_bytes().startswith(begins)
    assert (tmp_path / "run" / "trace.csv").read_bytes() == trace


def test_every_way_to_be_lost_has_a_mark_of_its_own() -> None:
    ways = {each.value for each in (*FateKind, *Rejection)} - {FateKind.DELIVERED}
    assert set(CAUSES) == ways
    assert len(set(CAUSES.values())) == len(ways)
    assert set(plots.CAUSES) == set(FateKind) - {FateKind.DELIVERED}
    assert len(set(plots.CAUSES.values())) == len(plots.CAUSES)
