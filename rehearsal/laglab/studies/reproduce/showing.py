"""What the experiments share: a picture as a file, runs over a grid."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from laglab.results.figures import plain
from laglab.scenario import Overrides, load
from laglab.studies.judged import joined
from laglab.studies.maps import StudyRuns, runs_of
from laglab.studies.sweep.cells.ways import judged
from laglab.studies.sweep.study import Study

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_WIDTH, MOST_DENSITY = 850, 100
"""[dots], [dots per inch] Enough on a screen, and small in a repository."""
N, M, P_0 = "link.command_delay", "link.measurement_delay", "estimator.initial_covariance"
WITHIN = 5.0
"""[m] Starts that are drawn are within this distance of the goal."""


def png(figure: Figure) -> bytes:
    """The picture as a file."""
    file = BytesIO()
    density = min(MOST_WIDTH / figure.get_figwidth(), MOST_DENSITY)
    with plain():
        figure.savefig(file, format="png", dpi=density)
    return file.getvalue()


def on_grid(
    name: str,
    scenario: str,
    grid: Mapping[str, Sequence[object]],
    seeds: int,
    overrides: Overrides | None = None,
    radius: float | None = WITHIN,
) -> StudyRuns:
    """A scenario over a grid and seeds, each with a start of its own but for `radius` None.

    The only place where the report makes runs by the dozen.
    """
    base = load(scenario, overrides)
    study = Study(base, range(1, seeds + 1), {k: tuple(v) for k, v in grid.items()}, radius, name)
    cells = list(study.cells(name))
    columns = joined(judged(cells))._asdict()
    for key in grid:
        columns[key] = np.repeat([cell.grid[key] for cell in cells], seeds)
    columns["seed"] = np.tile(study.seeds, len(cells))
    return runs_of(columns, grid, name, base)
