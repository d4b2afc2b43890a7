"""One cell of a study: what it is, whole, so that any machine can compute it from that alone."""

import hashlib
import json
import math
from collections.abc import Iterator
from functools import cached_property, lru_cache

import msgspec
import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from laglab.scenario import Scenario
from laglab.scenario.overrides import put
from laglab.scenario.toml import parsed

STARTS = 3
"""Of a seed's generators, that of the start."""


class Cell(Struct, frozen=True, dict=True):
    """A point of the grid, with some of the seeds: as many runs as there are seeds."""

    base: str
    """The study's scenario, whole, as TOML."""
    grid: dict[str, object]
    """Dotted key → the value here."""
    seeds: tuple[int, ...]
    radius: float | None
    """[m] Within which every seed has a start of its own about the goal; None: the scenario's."""
    origin: str
    """Of what else the runs depend on: a hash of the base, of the files that the study names, and
    of the code."""
    also: tuple[str, ...] = ()
    """Columns that other studies' rows do not have: some of ALARMS."""

    @cached_property
    def key(self) -> str:
        """Names the cell's file: another description, or other code, another key."""
        told = [self.origin, sorted(self.grid.items()), self.seeds, self.radius, self.also]
        return hashlib.sha256(json.dumps(told).encode()).hexdigest()[:32]

    @cached_property
    def scenario(self) -> Scenario:
        """What all of the runs have in common. Raises: ScenarioError, ValidationError."""
        fields: dict[str, object] = msgspec.msgpack.decode(_packed(self.base))
        for key, value in sorted(self.grid.items()):
            put(fields, key, value)
        return Scenario.model_validate(fields)

    def starts(self) -> NDArray[np.float64]:
        """Each run's first pose, shape (seeds, 3) [m, m, rad]."""
        return np.array([self._start(seed) for seed in self.seeds])

    def _start(self, seed: int) -> tuple[float, float, float]:
        if self.radius is None:
            return self.scenario.start
        u = np.random.default_rng((seed, STARTS)).random(3).tolist()
        distance = self.radius * math.sqrt(u[0])
        direction, heading = (math.tau * each - math.pi for each in u[1:])
        x, y, _ = self.scenario.goal
        return x + distance * math.cos(direction), y + distance * math.sin(direction), heading

    def runs(self) -> Iterator[Scenario]:
        """A scenario for every seed."""
        for seed in self.seeds:
            own = {"seed": seed, "start": self._start(seed)}
            yield self.scenario.model_copy(update=own)

    @property
    def place(self) -> str:
        """Where in the grid it is, in a few words."""
        there = ", ".join(f"{key} = {value}" for key, value in self.grid.items())
        return there or f"seeds {self.seeds[0]} to {self.seeds[-1]}"


@lru_cache(maxsize=16)
def _packed(base: str) -> bytes:
    """Many cells have the same, and TOML is slow to read."""
    return msgspec.msgpack.encode(parsed(base))
