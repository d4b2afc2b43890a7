"""A study's description: which scenario, over which values, with which seeds."""

import hashlib
import json
import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import islice, permutations, product
from pathlib import Path
from typing import Any

from laglab.errors import StudyError
from laglab.scenario import Scenario, changed
from laglab.scenario.explain import spelled
from laglab.scenario.model import FILES
from laglab.scenario.overrides import of_python
from laglab.studies.judged import ALARMS
from laglab.studies.sweep.cells.cell import Cell
from laglab.version import code_version
from laglab_control import FAR
from laglab_control.plugins import Group, source_of

MOST_SEED = 2**31
"""Seeds are below it."""
MOST_SEEDS = 250
"""Of one cell: enough for a task of its own, in a batch or not."""


@dataclass(frozen=True)
class Study:
    """A scenario, over the product of the grid's values and over seeds.

    Raises StudyError, when something in it cannot be. Whether the cells' scenarios can be, is not
    known before `work_left` has tried.
    """

    scenario: Scenario
    seeds: Sequence[int]
    grid: Mapping[str, Sequence[object]] = field(default_factory=dict)
    """Dotted scenario key → its values."""
    radius: float | None = None
    """[m] Every seed starts within it, about the goal; None: where the scenario says."""
    name: str = "study"
    description: str = ""
    also: tuple[str, ...] = ()
    """Columns besides those that every study has: some of alarm_s, alarm_error."""

    def __post_init__(self) -> None:
        if not isinstance(self.scenario, Scenario):
            raise StudyError(f"scenario: must be one, as `load` gives it, not {self.scenario!r}")
        object.__setattr__(self, "seeds", _seeds(self.seeds))
        object.__setattr__(self, "grid", {key: _axis(key, self.grid[key]) for key in self.grid})
        if "seed" in self.grid:
            raise StudyError("grid: seed: the seeds of a study are said by `seeds`")
        _refuse_said_twice(self.grid)
        if self.radius is not None and any(key.split(".")[0] == "start" for key in self.grid):
            raise StudyError(
                "grid: start: [start] gives every seed a start of its own: leave one out"
            )
        if self.radius is not None and not 0 < self.radius <= FAR:
            raise StudyError(f"start.radius: must be above 0, and {FAR:g} or less")
        if not isinstance(self.seeds, range) and len(set(self.seeds)) < len(self.seeds):
            raise StudyError("seeds: must have each seed once")
        if not self.seeds:
            raise StudyError("seeds: must have a seed at least")
        if unknown := [name for name in self.also if name not in ALARMS]:
            raise StudyError(f"also: {unknown[0]!r} is none of {', '.join(ALARMS)}")
        object.__setattr__(self, "also", tuple(name for name in ALARMS if name in self.also))

    @property
    def points(self) -> int:
        """How many the grid has."""
        return math.prod(len(values) for values in self.grid.values())

    @property
    def runs(self) -> int:
        """How many there are."""
        return self.points * len(self.seeds)

    def cells(self, origin: str | None = None) -> Iterator[Cell]:
        """One after the other; `origin`: a folder's, where that is not the one of this code."""
        origin, base = origin or self.origin, self._base
        for values in product(*self.grid.values()):
            grid = dict(zip(self.grid, values, strict=True))
            seeds = iter(self.seeds)
            while some := tuple(islice(seeds, MOST_SEEDS)):
                yield Cell(base, grid, some, self.radius, origin, self.also)

    @cached_property
    def origin(self) -> str:
        """What the cells depend on besides their place in the grid: base, files and code."""
        told = [code_version(), self._base, sorted(self._files()), sorted(self._brought())]
        return hashlib.sha256(json.dumps(told).encode()).hexdigest()[:32]

    @cached_property
    def _base(self) -> str:
        """Without what makes no difference to a run's row."""
        silent = {"description": "", "estimator.compare": [], "seed": 0}
        return changed(self.scenario, silent).to_toml()

    def _files(self) -> Iterator[tuple[str, str]]:
        """Those that the scenarios name, and a hash of each."""
        fields = self.scenario.fields()
        for table, key in (*FILES, ("law", "path")):
            of_base, of_grid = fields[table].get(key), self.grid.get(f"{table}.{key}", ())
            for name in map(str, filter(None, (of_base, *of_grid))):
                path = Path(name)
                if path.is_file():
                    yield name, hashlib.sha256(path.read_bytes()).hexdigest()

    def _brought(self) -> Iterator[tuple[str, str]]:
        """Names of what somebody brought, and a hash of the module of each."""
        chosen: tuple[tuple[Group, str, str], ...] = (
            ("laglab.estimators", "estimator.kind", self.scenario.estimator.kind),
            ("laglab.laws", "law.kind", self.scenario.law.kind),
            ("laglab.plants", "plant.kind", self.scenario.plant.kind),
        )
        for group, key, own in chosen:
            for name in {own, *map(str, self.grid.get(key, ()))}:
                if (path := source_of(group, name)) is not None:
                    yield name, hashlib.sha256(path.read_bytes()).hexdigest()

    def as_table(self) -> dict[str, object]:
        """As in a file, the scenario whole."""
        start = {} if self.radius is None else {"start": {"radius": self.radius}}
        return {
            "description": self.description,
            "seeds": self._told_seeds,
            **start,
            **({"also": list(self.also)} if self.also else {}),
            "grid": {key: list(values) for key, values in self.grid.items()},
            "scenario": self.scenario.fields(),
        }

    @property
    def _told_seeds(self) -> int | list[int]:
        number = len(self.seeds)
        return number if self.seeds == range(1, number + 1) else list(self.seeds)


def _seeds(seeds: Sequence[int]) -> Sequence[int]:
    """Each whole, 0 or more and below MOST_SEED. Raises: StudyError."""
    kept = seeds if isinstance(seeds, range) else tuple(_listed("seeds", seeds))
    ends = {kept[0], kept[-1]} if isinstance(kept, range) and kept else kept
    for seed in ends:
        if type(seed) is not int or not 0 <= seed < MOST_SEED:
            raise StudyError(f"seeds: must be whole, 0 or more and below 2^31, not {seed!r}")
    return kept


def _axis(key: str, values: Sequence[object]) -> tuple[object, ...]:
    """The values of one key; numbers all of one kind, so that they make a column.

    Raises: StudyError.
    """
    values = _listed(f"grid: {key}", values)
    if not values:
        raise StudyError(f"grid: {key}: must have a value at least, not []")
    kinds = {_kind(value) for value in values}
    if kinds == {int, float}:
        values, kinds = [float(value) for value in values], {float}
    if len(kinds) > 1:
        raise StudyError(f"grid: {key}: must have values of one kind, not {list(values)}")
    times = Counter(spelled(value) for value in values)
    if twice := next((text for text in times if times[text] > 1), None):
        raise StudyError(f"grid: {key}: must have each value once, not {twice} again")
    return tuple(values)


def _refuse_said_twice(grid: Mapping[str, Sequence[object]]) -> None:
    """Raises StudyError: what a table and a key within it both say is what the key says, whichever
    comes first, and rows would tell of both."""
    for whole, within in permutations(grid, 2):
        way = within.removeprefix(f"{whole}.")
        if way != within and any(_says(value, way) for value in grid[whole]):
            raise StudyError(f"grid: {within}: {whole}, too, says what it is: leave one out")


def _says(value: object, way: str) -> bool:
    """Whether a table says what is at this dotted key in it, or around that."""
    if isinstance(value, list):
        return True  # keys count its elements
    return isinstance(value, Mapping) and any(
        way == key or (way.startswith(f"{key}.") and _says(value[key], way[len(key) + 1 :]))
        for key in value
    )


def _listed(key: str, values: object) -> list[Any]:
    """Of Python's own kinds. Raises: StudyError, also for a text: nobody means its letters."""
    try:
        if not isinstance(values, str | bytes):
            return of_python(list(values))  # type: ignore[call-overload, no-any-return]
    except TypeError:
        pass
    raise StudyError(f"{key}: must be a list of values, not {values!r}")


def _kind(value: object) -> type:
    return type(value) if isinstance(value, bool | int | float) else str
