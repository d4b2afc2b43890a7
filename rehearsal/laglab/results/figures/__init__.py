"""Figures for papers and screens: a run, several runs laid over each other, a moving picture."""

from laglab.results.figures.moving import animation_place, save_animation
from laglab.results.figures.overlaid import draw_runs, labels
from laglab.results.figures.saving import FIGURE_FILE, picture_place, save, save_figure
from laglab.results.figures.settings import plain
from laglab.results.figures.style import INCHES, Width, legend, line, printed, sheet
from laglab.results.figures.whole import draw_run, title

__all__ = [
    "FIGURE_FILE",
    "INCHES",
    "Width",
    "animation_place",
    "draw_run",
    "draw_runs",
    "labels",
    "legend",
    "line",
    "picture_place",
    "plain",
    "printed",
    "save",
    "save_animation",
    "save_figure",
    "sheet",
    "title",
]
