"""The runs of a study as columns, one entry a run, and which of them is which."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.errors import StudyError
from laglab.scenario import Scenario

if TYPE_CHECKING:
    import pandas

Column = NDArray[np.generic]
MOST_PANELS = 6


class StudyRuns(NamedTuple):
    """What is drawn. A column holds NaN or None where a run has no such value."""

    name: str
    columns: Mapping[str, Column]
    grid: Mapping[str, Sequence[object]]
    """Each key's values, in order. The keys are columns too."""
    base: Scenario | None
    """What the runs have in common; without it no delay margin is drawn."""

    def values(self, key: str) -> list[object]:
        """Those of a key that runs have; numbers from small to large."""
        there = set(self.columns[key].tolist())
        found = [value for value in self.grid[key] if value in there]
        return sorted(found, key=float) if self.is_numeric(key) else found  # type: ignore[arg-type]

    def is_numeric(self, key: str) -> bool:
        """Whether its values can be put on a scale."""
        return self.columns[key].dtype.kind in "iuf"

    @property
    def diverged(self) -> NDArray[np.bool_]:
        """Of every run, whether its estimate did."""
        if "diverged_tick" not in self.columns:
            return np.zeros(len(next(iter(self.columns.values()))), dtype=bool)
        there: NDArray[np.bool_] = ~np.isnan(self.number("diverged_tick"))
        return there

    def number(self, column: str) -> NDArray[np.float64]:
        """A column of results, NaN for nothing. Raises: StudyError, when it has no numbers."""
        try:
            return np.array([np.nan if v is None else v for v in self.columns[column]], dtype=float)
        except KeyError:
            raise StudyError(
                f"--value: there is no column {column!r}; there are {', '.join(self.columns)}"
            ) from None
        except (TypeError, ValueError):
            raise StudyError(f"--value: column {column!r} does not hold numbers") from None


def runs_of(
    table: Mapping[str, Column] | pandas.DataFrame,
    grid: Mapping[str, Sequence[object]],
    name: str = "study",
    base: Scenario | None = None,
) -> StudyRuns:
    """Of a table with a column for each key of the grid, and those of the results."""
    columns = {str(column): np.asarray(table[column]) for column in table}
    return StudyRuns(name, columns, grid, base)


class Layout(NamedTuple):
    """Which key goes where."""

    x: str
    y: str | None
    """None: there is only one key to draw along."""
    panels: str | None
    averaged: tuple[str, ...]


def layout(
    runs: StudyRuns, x: str | None = None, y: str | None = None, panels: str | None = None
) -> Layout:
    """The two keys with the most values, numbers first, are x and y; panels are made by a key that
    is on no scale, as a filter's name, and else by the next one.

    Raises: StudyError, when one that is given is no key of the grid, or nothing was varied.
    """
    _check(runs, {"--x": x, "--y": y, "--panels": panels})
    left = [key for key in _by_size(runs) if key not in (x, y, panels)]
    numeric = [key for key in left if runs.is_numeric(key)]
    if x is None:
        x = (numeric or left or [None])[0]  # type: ignore[list-item]
    if x is None and panels:
        raise StudyError(f"--panels: beside {panels} nothing was varied: leave it out")
    if x is None:
        raise StudyError(f"{runs.name}: its grid has one value of each key: no map to draw")
    left, numeric = ([key for key in of if key != x] for of in (left, numeric))
    if y is None and numeric:
        y = numeric[0]
    left = [key for key in left if key != y]
    few = [key for key in left if len(runs.values(key)) <= MOST_PANELS]
    if panels is None:
        panels = next((key for key in few if not runs.is_numeric(key)), few[0] if few else None)
    return Layout(x, y, panels, tuple(key for key in left if key != panels))


def _check(runs: StudyRuns, asked: Mapping[str, str | None]) -> None:
    """Raises StudyError: what an option asks for is no key of the grid, or another's."""
    by_key: dict[str, str] = {}
    for option, key in asked.items():
        if key is None:
            continue
        if key not in runs.grid:
            raise StudyError(
                f"{option}: {key!r} is not a key of this study's grid: {', '.join(runs.grid)}"
            )
        if key in by_key:
            raise StudyError(f"{by_key[key]} and {option} are both {key!r}: take two keys")
        by_key[key] = option
    if (key := asked["--panels"]) and (many := len(runs.values(key))) > MOST_PANELS:
        raise StudyError(
            f"--panels: {key} has {many} values, and {MOST_PANELS} panels have room: take another"
        )


def _by_size(runs: StudyRuns) -> list[str]:
    """Those with more than one value, the most first; of two alike the first in the grid."""
    sizes = {key: len(runs.values(key)) for key in runs.grid}
    return sorted((key for key in runs.grid if sizes[key] > 1), key=lambda key: -sizes[key])
