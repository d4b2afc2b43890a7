"""Runs beside each other as a moving picture."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from laglab.errors import PlaceError, ResultsError
from laglab.files import file_place, write_whole
from laglab.results.figures.overlaid import labels
from laglab.results.figures.panels import COMPONENTS, around, marked
from laglab.results.figures.plane import fit, mark_ends
from laglab.results.figures.shown import Shown, shown
from laglab.results.figures.style import BLACK, BLUE, GREY, PALE, legend, line, printed, sheet

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from laglab.results.run import Run

WIDTH, HEIGHT, BELOW = 5.6, 2.6, 1.1
"""[inch] The width of the whole, the heights of the paths and of what is below them."""
DOTS_PER_INCH = 96
FRAMES_PER_SECOND = 10
MOST_FRAMES = 150
"""A longer run goes faster."""
HELD = 12
"""Frames for which the end is shown."""
ROBOT = np.array([[1.0, 0.0], [-0.7, 0.6], [-0.4, 0.0], [-0.7, -0.6]])
"""Seen from above, heading along x."""
SIZE = 0.055
"""The robot's size, as a share of the panel's."""


def animation_place(path: Path) -> Path:
    """Where `--out` wants a moving picture: a GIF. Raises PlaceError."""
    if path.suffix.lower() != ".gif":
        raise PlaceError(f"--out {path}: its name must end in gif")
    return file_place("--out", path)


def save_animation(runs: Sequence[Run], path: Path) -> None:
    """The robots on their ways and their headings, side by side, as an endless GIF.

    Raises ResultsError.
    """
    with printed():
        from matplotlib.animation import FuncAnimation, PillowWriter

        scene = Scene([shown(run) for run in runs], labels(runs))
        movie = FuncAnimation(
            scene.figure, scene.show, frames=list(scene.times()), init_func=list, blit=False
        )

        class Writer(PillowWriter):
            def finish(self) -> None:
                with suppress(IndexError):  # of no frame: who interrupts before the first
                    super().finish()

        writer = Writer(fps=FRAMES_PER_SECOND)
        beside = path.with_name(f".{path.name}.new.gif")
        try:
            movie.save(str(beside), writer=writer, dpi=DOTS_PER_INCH)
            write_whole(path, beside.read_bytes())
        except OSError as error:
            raise ResultsError(f"cannot write {path}: {error.strerror or error}") from error
        finally:
            beside.unlink(missing_ok=True)


class Scene:
    """A panel for each path, and all headings below; what moves is moved from time to time."""

    def __init__(self, told: Sequence[Shown], names: Sequence[str]) -> None:
        self._told = told
        self.figure: Figure = sheet(WIDTH, HEIGHT + BELOW)
        paths = tuple(f"path {number}" for number in range(len(told)))
        rows = [paths, ("heading",) * len(told)]
        panels = self.figure.subplot_mosaic(
            [list(row) for row in rows], height_ratios=(HEIGHT, BELOW)
        )
        self._robots = [
            _Robot(panels[path], each, name)
            for path, each, name in zip(paths, told, names, strict=True)
        ]
        for each in self._robots:
            fit(each.axes, [one.pose for one in told], told[0].target)
            each.axes.set_adjustable("box")
        self._draw_headings(panels["heading"], names)
        self._cursor = panels["heading"].axvline(0.0, color=BLACK, linewidth=0.8)
        self.show(0.0)
        self.figure.draw_without_rendering()
        self.figure.set_layout_engine("none")  # nothing is to shift from frame to frame

    def _draw_headings(self, axes: Axes, names: Sequence[str]) -> None:
        for number, (each, name) in enumerate(zip(self._told, names, strict=True)):
            marked(axes, each.time, each.pose[:, 2], line(number), number, name)
        around(axes, np.concatenate([each.pose[:, 2] for each in self._told]))
        axes.set(xlabel=self._told[0].clock.label, ylabel=COMPONENTS[2])
        axes.set_xlim(0, self._end)
        legend(axes)

    @property
    def _end(self) -> float:
        return max(each.span[1] for each in self._told)

    def times(self) -> Iterator[float]:
        """Of the frames, in the runs' unit."""
        seconds = self._end * self._told[0].clock.seconds
        count = int(min(MOST_FRAMES, max(2, seconds * FRAMES_PER_SECOND)))
        yield from np.linspace(0.0, self._end, count)
        yield from [self._end] * HELD

    def show(self, time: float) -> list[Artist]:
        """Move all to where it was then."""
        for robot in self._robots:
            robot.move(time)
        self._cursor.set_xdata([time, time])
        return []


class _Robot:
    """One robot on its way."""

    def __init__(self, axes: Axes, told: Shown, name: str) -> None:
        self.axes = axes
        self._told = told
        self._name = name
        pose = told.pose
        axes.plot(*pose[:, :2].T, color=PALE, linewidth=0.8)
        (self._trail,) = axes.plot([], [], color=BLUE, linewidth=1.2)
        mark_ends(axes, pose[:1], told.target)
        self._body = axes.fill([0, 0], [0, 0], color=BLACK, linewidth=0, zorder=5)[0]
        self._guess = axes.fill(
            [0, 0], [0, 0], facecolor="none", edgecolor=GREY, linewidth=0.8, zorder=6
        )[0]

    def move(self, time: float) -> None:
        row = int(np.searchsorted(self._told.time, time, side="right").clip(1)) - 1
        self._trail.set_data(*self._told.pose[: row + 1, :2].T)
        self._body.set_xy(self._outline(self._told.pose[row]))
        self._guess.set_xy(self._outline(self._told.estimate[row]))
        unit = self._told.clock.unit
        self.axes.set_title(f"{self._name}: {self._told.estimator}, {time:.1f} {unit}")

    def _outline(self, pose: NDArray[np.float64]) -> NDArray[np.float64]:
        low, high = self.axes.get_xlim()
        x, y, theta = pose
        cos, sin = np.cos(theta), np.sin(theta)
        turned = ROBOT @ np.array([[cos, sin], [-sin, cos]])
        outline: NDArray[np.float64] = turned * SIZE * (high - low) + (x, y)
        return outline
