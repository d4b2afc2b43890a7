"""The report, as a browser shows it."""

import io
from dataclasses import replace as replace_
from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace
from PIL import Image

from laglab import Run, load_study, run, sweep
from laglab.results.link_view import link_view
from laglab.results.report import report, report_html, save_report
from laglab.results.report.reading import tables_of
from laglab.results.run import Kept
from laglab.results.table import summary_rows
from laglab.scenario import load
from laglab.studies.maps.page import save_study_page
from laglab_gateway import ARRIVALS_FILE, ROWS

from .browser import Tab

pytestmark = [pytest.mark.slow, pytest.mark.timeout(180)]
MOST_BYTES = 4_000_000


def opened(tab: Tab, page: Path, runs: list[Run]) -> None:
    """Without a word of complaint, and without asking anybody for anything."""
    save_report(runs, page)
    assert page.stat().st_size < MOST_BYTES
    tab.open(page.as_uri())
    assert tab.errors == []
    assert [each for each in tab.requests if not each.startswith(("file:", "data:"))] == []


def look(tab: Tab, time: float) -> None:
    """As if somebody had moved the slider there."""
    tab.value(f"slider.value = {time}; slider.dispatchEvent(new Event('input')); 1")


def where(tab: Tab, run: int = 0) -> tuple[float, float]:
    """Between the wheels, which are its second corner and its last."""
    x, y = tab.column(f"robot-{run}", "x"), tab.column(f"robot-{run}", "y")
    return (x[1] + x[3]) / 2, (y[1] + y[3]) / 2


def seen(tab: Tab) -> np.ndarray:
    picture: np.ndarray = np.asarray(
        Image.open(io.BytesIO(tab.picture(whole=False))).convert("RGB"), dtype=int
    )
    return picture


def test_it_tells_of_the_run(tab: Tab, page: Path, radio: Run) -> None:
    opened(tab, page, [radio])
    assert tab.text(".verdict").strip() == radio.summary.verdict
    for name, cell in summary_rows(radio).items():
        assert name in tab.text("#summary")
        assert cell in tab.text("#summary")
    assert 'name = "lab-radio"' in tab.text("pre")
    assert np.allclose(tab.column("ticks-0", "x"), radio.trace["x"], atol=1e-6)
    lost = np.count_nonzero(radio.link["fate"] != "delivered")
    refused = np.count_nonzero(radio.arrivals["refused"] != "no")
    assert radio.summary.link is not None
    assert len(tab.column("marks-0", "what")) == lost + refused + radio.summary.link.stops
    assert "by itself" in tab.column("marks-0", "what")
    assert {"lost", "burst"} <= set(tab.column("marks-0", "what"))


def test_the_slider_moves_the_robot(tab: Tab, page: Path, radio: Run) -> None:
    opened(tab, page, [radio])
    for tick in (0, 250, 500):
        look(tab, tick * 0.01)
        told = radio.trace["x"][tick], radio.trace["y"][tick]
        assert where(tab) == pytest.approx(told, abs=1e-5)
        assert f"tick {tick}," in tab.text("#readout-0")
    assert tab.column("now-0", "time") == [5.0]


def test_uncertainty_and_commands_in_flight(tab: Tab, page: Path, pushed: Run) -> None:
    opened(tab, page, [pushed])
    tick = 150
    look(tab, tick * 0.01)
    x, y = tab.column("ellipse-0", "x"), tab.column("ellipse-0", "y")
    deviation = np.sqrt(pushed.claims["p_xx"][tick]), np.sqrt(pushed.claims["p_yy"][tick])
    middle = pushed.trace["x_est"][tick], pushed.trace["y_est"][tick]
    assert (np.mean(x), np.mean(y)) == pytest.approx(middle, abs=1e-4)
    assert ((max(x) - min(x)) / 4, (max(y) - min(y)) / 4) == pytest.approx(deviation, rel=0.02)
    assert "10 commands in flight" in tab.text("#readout-0")
    ahead = pushed.trace["x"][tick + 11], pushed.trace["y"][tick + 11]
    end = tab.column("flight-0", "x")[-1], tab.column("flight-0", "y")[-1]
    assert end == pytest.approx(ahead, abs=0.03)


def test_the_picture_moves(tab: Tab, page: Path, radio: Run) -> None:
    opened(tab, page, [radio])
    look(tab, 0.0)
    before = seen(tab)
    look(tab, 3.0)
    tab.wait("new Promise(done => requestAnimationFrame(() => setTimeout(done, 200, true)))")
    after = seen(tab)
    assert (before < 128).any(axis=2).mean() > 0.01  # there is ink
    assert 0.001 < (np.abs(before - after).max(axis=2) > 60).mean() < 0.2


def test_two_runs_side_by_side(tab: Tab, page: Path, radio: Run, pushed: Run) -> None:
    opened(tab, page, [radio, pushed])
    look(tab, 2.0)
    assert where(tab, 0) == pytest.approx((radio.trace["x"][200], radio.trace["y"][200]), abs=1e-5)
    assert where(tab, 1) == pytest.approx(
        (pushed.trace["x"][200], pushed.trace["y"][200]), abs=1e-5
    )
    assert [tab.value(f"document.querySelectorAll('h2.of-run')[{i}].textContent") for i in (0, 1)]
    left, right = (
        tab.value(f"document.querySelectorAll('.plot.path')[{i}].getBoundingClientRect().x")
        for i in (0, 1)
    )
    assert left < right
    ranges = "Bokeh.documents[0].roots().map(root => root.x_range.id)"
    assert len(set(tab.value(ranges))) == 2  # the plane's, and one of time


def test_on_a_narrow_screen_nothing_sticks_out(tab: Tab, page: Path, radio: Run) -> None:
    save_report([radio], page)
    tab.open(page.as_uri(), wide=400)
    tab.wait("document.documentElement.scrollWidth <= 400")


def test_what_others_wrote_is_text(tab: Tab, page: Path, radio: Run) -> None:
    hostile = "</script><img src=x onerror=alert(1)><script>alert(2)</script>"
    scenario = radio.scenario.model_copy(update={"name": hostile, "description": hostile})
    opened(tab, page, [Run(scenario, radio.summary, radio.directory)])
    assert tab.value("document.images.length") == 0
    assert hostile in tab.text("h1")


def test_a_long_run_is_thinned_and_keeps_its_peaks(radio: Run) -> None:
    rows = 200_000
    times = np.arange(rows) * 0.01
    trace = {name: np.zeros(rows) for name in radio.trace} | {
        "tick": np.arange(rows, dtype=float),
        "time": times,
    }
    arrived = np.arange(rows) + 10
    arrived[123_456] += 90
    empty = {name: column[:0] for name, column in radio.arrivals.items()}
    arrivals = empty | {
        "direction": np.full(rows, "command"),
        "tick": np.arange(rows),
        "arrived": arrived,
        "time": arrived * 0.01,
        "refused": np.full(rows, "no"),
    }
    nothing = {
        name: {column: np.zeros(0) for column in kind._fields} for name, kind in ROWS.items()
    }
    tables = nothing | {ARRIVALS_FILE: arrivals}
    long = Run(
        load("lab", {"duration": rows * 0.01}),
        replace(radio.summary, ticks=rows - 1),
        None,
        Kept(trace, tables, {}),
    )
    assert tables_of(long, link_view(long), 5_000).commands["delay"].max() == 100
    assert len(report_html([long])) < MOST_BYTES


def test_what_takes_more_room_is_drawn_with_fewer_ticks(
    radio: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = report_html([radio])
    monkeypatch.setattr(report, "LARGEST", len(whole.encode()) - 10_000)
    assert len(report_html([radio]).encode()) <= report.LARGEST


def test_what_is_hatched_is_what_was_measured(tab: Tab, page: Path) -> None:
    """An event stands in for the link, outages and all; a run may end before an outage does."""
    events = [{"at": 0.4, "duration": 0.2, "link": {"outages": [[0.5, 0.8]]}}]
    events += [{"at": 0.9, "duration": 1.0, "link": {"loss": 1.0}}]
    base = {"link.command.outages": [[0.45, 0.1]], "link.measurement_delay": 0}
    made = run("lab", {**base, "link.event": events, "duration": 1.2})
    opened(tab, page, [made])
    hatched = tab.value(
        "Array.from(Bokeh.documents[0].all_models).filter(m => m.type === 'BoxAnnotation'"
        " && m.hatch_pattern === '/').map(m => m.left.toFixed(2) + '-' + m.right.toFixed(2))"
    )
    measured = {f"{span.start:.2f}-{span.end:.2f}" for span in link_view(made).outages}
    assert set(hatched) == measured == {"0.50-0.60", "0.90-1.21"}


def test_a_study_is_a_page_of_maps(tab: Tab, tmp_path: Path) -> None:
    study = load_study("delay-map")
    grid = {"link.command_delay": (0, 20), "link.measurement_delay": (0, 20)}
    few = replace_(study, grid=grid, seeds=(1, 2))
    few = replace_(few, scenario=few.scenario.overridden({"duration": 1.0}))
    result = sweep(few, out=tmp_path / "study")
    page = tmp_path / "page.html"
    save_study_page(few, result.directory, ["8 runs & more"], page)
    tab.open(page.as_uri())
    assert tab.errors == []
    assert [each for each in tab.requests if not each.startswith(("file:", "data:"))] == []
    assert tab.text(".verdict") == "8 runs & more"
    cells = "Bokeh.documents[0].roots()[0].renderers[0].data_source.data"
    assert tab.value(f"Array.from({cells}.x)") == ["0", "20", "0", "20"]
    assert len(tab.value(f"Array.from({cells}.centre)")) == 4
