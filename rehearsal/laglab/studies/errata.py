"""What each misprint of the paper costs: the filter as corrected, as printed, and in between."""

from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

import numpy as np
from msgspec import Struct
from msgspec.structs import astuple
from rich.table import Table

from laglab.interface import run
from laglab.results.summary import Errors
from laglab.scenario import Scenario, changed
from laglab.studies.workers import shared_out
from laglab.tables import plain_table
from laglab_control import Erratum, PrintedController

EXACT = 1e-9
"""[m, rad] Below this, an error is rounding."""


class Variant(NamedTuple):
    """A version of the filter, by the errata that are put back into it."""

    name: str
    errata: frozenset[Erratum]


VARIANTS = (
    Variant("as corrected", frozenset()),
    *(
        Variant(f"({erratum.equation}) {erratum.printed}", frozenset({erratum}))
        for erratum in Erratum
    ),
    Variant("all as printed", frozenset(Erratum)),
)


class Cost(NamedTuple):
    """How one variant did: without noise, and over some seeds with noise."""

    name: str
    errors: Errors | None
    converged: bool
    noisy_errors: Errors | None
    """The mean over the runs that did not diverge; None when all did."""
    diverged: int
    seeds: int


class Costing(Struct, frozen=True):
    """A variant to be tried."""

    scenario: str
    """As TOML."""
    variant: Variant
    seeds: int


def costs(scenario: Scenario, seeds: int, workers: int) -> Iterator[tuple[Variant, Cost]]:
    """Every variant in the loop of the scenario, as they are done. Raises RunError."""
    jobs = [Costing(scenario.to_toml(), variant, seeds) for variant in VARIANTS]
    return shared_out(tried, jobs, workers)


def tried(job: Costing) -> tuple[Variant, Cost]:
    """In a worker: one variant."""
    return job.variant, cost(Scenario.from_toml(job.scenario), job.variant, job.seeds)


def noisy(scenario: Scenario, number: int) -> Scenario:
    """With noise, and the seed of that number; 0 is its own. Raises ScenarioError."""
    return changed(scenario, {"noise": True, "seed": scenario.seed + number})


def cost(scenario: Scenario, variant: Variant, seeds: int) -> Cost:
    """Of one variant: without noise, and with it over the seeds."""
    errors, converged, _ = _trial(changed(scenario, {"noise": False}), variant)
    trials = [_trial(noisy(scenario, number), variant) for number in range(seeds)]
    kept = [errors for errors, _, whole in trials if whole and errors]
    return Cost(variant.name, errors, converged, _mean(kept), seeds - len(kept), seeds)


def _trial(scenario: Scenario, variant: Variant) -> tuple[Errors | None, bool, bool]:
    """RMS error, whether the robot converged, and whether the estimate did not diverge."""
    alone = changed(scenario, {"estimator.kind": "popf", "estimator.compare": []})
    done = run(alone, controller=partial(PrintedController, errata=variant.errata)).summary
    return done.rms_error, done.converged, done.outcome == "completed"


def _mean(errors: list[Errors]) -> Errors | None:
    if not errors:
        return None
    return Errors(*np.mean([astuple(each) for each in errors], axis=0).tolist())


def costs_table(scenario: Scenario, rows: list[Cost]) -> Table:
    """One line a variant."""
    table = plain_table(
        *("as printed in", "without noise", "converges", "with noise", "diverged"),
        title=f"{scenario.name}: popf, n = {scenario.link.n}, "
        f"m = {scenario.link.m}, P_0 = {scenario.estimator.initial_covariance:g} I",
        caption="RMS error of the estimate in x (m), y (m), θ (rad); diverged: runs with noise",
    )
    for row in rows:
        table.add_row(
            row.name,
            _spelled(row.errors),
            "yes" if row.converged else "no",
            _spelled(row.noisy_errors),
            f"{row.diverged}/{row.seeds}",
        )
    return table


def _spelled(errors: Errors | None) -> str:
    if errors is None:
        return "-"
    values = astuple(errors)
    return "exact" if max(values) < EXACT else ", ".join(f"{value:.2g}" for value in values)
