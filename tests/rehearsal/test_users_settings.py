"""Whatever a user tells matplotlib, our pictures look as they do, and cost no run its verdict."""

import subprocess
import sys
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib as mpl
import pytest

import laglab
from laglab.results.figures import save, save_animation
from laglab.studies.maps import draw_study
from laglab.studies.maps.runs import StudyRuns
from laglab.studies.reproduce.showing import on_grid, png

SHORT = ("run", "fig6", "--duration", "0.2", "--out", "run")
THEIRS = {
    "text.usetex": True,
    "font.family": ["a font that nobody has"],
    "lines.linewidth": 9.0,
    "axes.facecolor": "red",
    "axes.formatter.limits": [-1, 1],
    "xtick.major.size": 20.0,
    "figure.dpi": 33.0,
    "savefig.dpi": 30.0,
    "savefig.bbox": "tight",
}


def rc_file(settings: dict[str, Any]) -> str:
    told = ((k, ", ".join(map(str, v)) if isinstance(v, list) else v) for k, v in settings.items())
    return "".join(f"{key}: {value}\n" for key, value in told)


@pytest.fixture(scope="module")
def short() -> laglab.Run:
    return laglab.run("lab-radio", {"duration": 0.5, "estimator.compare": ["ekf"]})


@pytest.fixture(scope="module")
def study() -> StudyRuns:
    grid = {"link.command_delay": [1, 20], "link.measurement_delay": [1, 20]}
    return on_grid("maps", "fig6", grid, seeds=1, overrides={"duration": 0.2})


@pytest.mark.slow
def test_a_command_draws_as_ever(
    tmp_path: Path, laglab: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert laglab(*SHORT).returncode == 0
    usual = (tmp_path / "run" / "figure.png").read_bytes()
    (tmp_path / "matplotlibrc").write_text(rc_file(THEIRS), "utf-8")
    monkeypatch.setenv("MPLCONFIGDIR", str(tmp_path))
    monkeypatch.setenv("MPLBACKEND", "nonsense")
    done = laglab(*SHORT, "--force")
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "run" / "figure.png").read_bytes() == usual


def test_what_a_run_and_a_study_show_is_the_same(short: laglab.Run, study: StudyRuns) -> None:
    def pictures() -> list[bytes]:
        figures = short.figure(), draw_study(study, ["rms_x"])
        return [each._repr_png_() for each in figures] + [png(draw_study(study, ["converged"]))]  # type: ignore[attr-defined]

    usual = pictures()
    with mpl.rc_context(THEIRS):
        assert pictures() == usual


@pytest.mark.slow
def test_what_is_saved_is_the_same(short: laglab.Run, study: StudyRuns, tmp_path: Path) -> None:
    def pictures() -> list[bytes]:
        save(short.figure("one"), tmp_path / "run.png")
        save(draw_study(study), tmp_path / "map.png")
        save_animation([short], tmp_path / "run.gif")
        return [(tmp_path / name).read_bytes() for name in ("run.png", "map.png", "run.gif")]

    usual = pictures()
    with mpl.rc_context(THEIRS):
        assert pictures() == usual


@pytest.mark.parametrize("ending", ["png", "pdf", "svg"])
def test_users_write_figures_themselves_their_way(ending: str, short: laglab.Run) -> None:
    """How large a file is remains theirs to say; so does how a PDF holds its letters, part of which
    is written when all is drawn."""
    figure, file = short.figure(), BytesIO()
    with mpl.rc_context(THEIRS | {"pdf.fonttype": 42}):
        figure.savefig(file, format=ending)
        assert mpl.rcParams["text.usetex"]
    written = file.getvalue()
    if ending == "png":
        assert int.from_bytes(written[16:20]) < 7 * 40
    elif ending == "pdf":
        assert b"/Type3" not in written


@pytest.mark.parametrize(("told", "kept"), [("svg", True), ("nonsense", False)])
def test_a_users_backend_remains_theirs(
    told: str, kept: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    code = """if True:
        import os
        from laglab.results.figures import sheet
        sheet(1, 1)
        import matplotlib
        print(os.environ["MPLBACKEND"], matplotlib.rcParams["backend"])"""
    monkeypatch.setenv("MPLBACKEND", told)
    said = subprocess.check_output([sys.executable, "-c", code], text=True, timeout=60)
    environment, backend = said.split()
    assert environment == told
    assert (backend == told) is kept


def test_settings_that_cannot_be_read_are_told_and_cost_no_verdict(
    tmp_path: Path, laglab: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "matplotlibrc").write_bytes(b"font.family: Universit\xe9\n")
    monkeypatch.setenv("MPLCONFIGDIR", str(tmp_path))
    done = laglab(*SHORT)
    assert done.returncode == 0, done.stderr
    assert "warning: matplotlib cannot read its matplotlibrc" in done.stderr
    assert "converge" in done.stdout
    done = laglab("figure", "run", "--out", "again.png")
    assert done.returncode == 4
    assert done.stderr.splitlines()[-1].startswith(
        "laglab: matplotlib cannot read its matplotlibrc"
    )


def test_what_breaks_a_picture_is_a_warning_of_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> None:
        raise RuntimeError("latex could\nnot be found")

    monkeypatch.setattr("laglab.results.run.draw_run", broken)
    run = laglab.run("fig6", {"duration": 0.2}, out=tmp_path / "run")
    assert run.summary.outcome == "completed"
    assert run.summary.warnings[-1].endswith("figure.png cannot be drawn: latex could not be found")
    assert laglab.open_run(tmp_path / "run").summary == run.summary
