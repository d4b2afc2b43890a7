"""Moving pictures: the command makes one, and the README opens with one that it made."""

import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

import laglab
from laglab.results.figures.moving import Scene, save_animation
from laglab.results.figures.shown import shown

ROOT = Path(__file__).parents[2]
MOST = 1_000_000
"""[bytes] Of a picture that a page opens with."""


@pytest.mark.slow
def test_the_robots_move_side_by_side(tmp_path: Path, ended: Callable[..., Any]) -> None:
    for name in ("fig5", "fig6"):
        laglab.run(name, {"duration": 0.5}, out=tmp_path / name)
    out = tmp_path / "both.gif"
    done = ended("animate", tmp_path / "fig5", tmp_path / "fig6", "--out", out)
    assert (done.code, done.out.strip()) == (0, str(out))
    assert [each.name for each in tmp_path.iterdir() if each.is_file()] == ["both.gif"]
    with Image.open(out) as picture:
        assert picture.n_frames == 5  # type: ignore[attr-defined]
        first = picture.convert("RGB").tobytes()
        picture.seek(4)
        assert picture.convert("RGB").tobytes() != first


def test_each_robot_is_drawn_where_it_was() -> None:
    run = laglab.run("lab", {"duration": 1.0})
    scene = Scene([shown(run)], ["lab"])
    scene.show(0.5)
    (axes, _) = scene.figure.axes
    body, guess = (patch.get_xy()[:-1].mean(axis=0) for patch in axes.patches)
    size = axes.get_xlim()[1] - axes.get_xlim()[0]
    for place, suffix in ((body, ""), (guess, "_est")):
        true = [run.trace[axis + suffix][50] for axis in ("x", "y")]
        assert place == pytest.approx(true, abs=0.02 * size)


def test_an_interrupt_before_the_first_frame_is_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The library had no file to make of no frames, and said so instead."""
    run = laglab.run("lab", {"duration": 0.1})
    monkeypatch.setattr(Scene, "times", lambda _: iter([-1.0]))
    show = Scene.show

    def interrupted(scene: Scene, time: float) -> list[Any]:
        if time < 0:
            signal.raise_signal(signal.SIGINT)
        return show(scene, time)

    monkeypatch.setattr(Scene, "show", interrupted)
    with pytest.raises(KeyboardInterrupt):
        save_animation([run], tmp_path / "run.gif")
    assert not list(tmp_path.iterdir())


def test_what_is_no_gif_is_refused(refused: Callable[..., str]) -> None:
    line = refused("animate", "run", "--out", "run.mp4")
    assert line == "laglab: --out run.mp4: its name must end in gif"


def test_the_readme_opens_with_a_figure_and_a_moving_picture() -> None:
    opening = (ROOT / "README.md").read_text("utf-8").split("\n## ")[0]
    for name in ("docs/fig5-fig6.gif", "docs/fig5-fig6.png"):
        assert f"]({name})" in opening
        assert (ROOT / name).stat().st_size < MOST
    with Image.open(ROOT / "docs" / "fig5-fig6.gif") as picture:
        assert picture.n_frames > 50  # type: ignore[attr-defined]
