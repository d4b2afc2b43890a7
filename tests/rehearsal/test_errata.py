"""``laglab errata``: each misprint on its own, and all together."""

import pytest
from msgspec.structs import astuple

from laglab.scenario import load
from laglab.studies.errata import VARIANTS, cost, costs
from laglab_control import Erratum


@pytest.mark.slow
def test_what_each_misprint_costs():
    """Without noise only the innovation of (28) shows: it alone keeps the robot from its goal."""
    rows = dict(costs(load("fig8", {"duration": 5.0}), seeds=1, workers=2))
    assert set(rows) == set(VARIANTS)
    by_errata = {variant.errata: cost for variant, cost in rows.items()}
    corrected = by_errata[frozenset()]
    assert corrected.converged
    assert max(astuple(corrected.errors)) < 1e-12
    for erratum in set(Erratum) - {Erratum.INNOVATION}:
        assert by_errata[frozenset({erratum})].converged
    innovation = by_errata[frozenset({Erratum.INNOVATION})]
    assert not innovation.converged
    assert innovation.errors.x > 0.1
    assert innovation.noisy_errors.x > 10 * corrected.noisy_errors.x
    assert not by_errata[frozenset(Erratum)].converged


def test_it_is_popf_whatever_the_scenario_s_filter_is():
    variant = VARIANTS[-1]
    popf, raw = (
        cost(load("fig8", {"duration": 2.0, "estimator.kind": kind}), variant, seeds=1)
        for kind in ("popf", "raw")
    )
    assert raw == popf


def test_the_command_prints_a_line_for_each(ended_here):
    code, out, errors = ended_here("errata", "fig6", "--duration", "1", "--seeds", "1")
    assert code == 0, errors
    for erratum in Erratum:
        assert f"({erratum.equation}) {erratum.printed}" in out
    assert "as corrected" in out


def test_seeds_that_are_none_are_refused_before_anything_runs(refused):
    said = refused("errata", "fig6", "--seed", str(2**31 - 2), "--seeds", "3")
    assert "fig6: seed: must be below 2147483648" in said
