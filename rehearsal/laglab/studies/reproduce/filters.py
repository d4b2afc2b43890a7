"""Claims on the filter's equations: section 3, (31) and (32)."""

from __future__ import annotations

from functools import partial

import numpy as np

from laglab.interface import run
from laglab.results.numbers import loop_estimates, measurements, shadow_estimates
from laglab.scenario import load
from laglab.studies.consistency import Job, chi_square_bounds, consistencies, judge, nth
from laglab.studies.errata import VARIANTS, Variant, cost
from laglab.studies.reproduce.claim import Claim, Evidence, Verdict, never
from laglab_control import Erratum, Popf, RobotModel, constant_delay, replay

SEEDS = 4
CHANCE = 1e-3
"""[m] A difference of RMS errors below it is chance, with so few seeds."""
CORRECTED = VARIANTS[0]
P_0 = 1e-2
"""[m², rad²] As large as R."""
MOVED = 100
"""The tick at which a measurement is moved."""


def without_delay() -> Evidence:
    """The filter and the EKF on one record, with noise, m = 0."""
    trace = run("fig8", {"link.measurement_delay": 0}).trace
    apart = loop_estimates(trace) - shadow_estimates(trace, "ekf")
    return Evidence({"apart": float(np.abs(apart).max())})


def first_felt() -> Evidence:
    """When a measurement first shows in the estimate: one of the record is moved by a metre."""
    done = run("fig8")
    m = done.scenario.link.measurement_delay
    trace, start = done.trace, np.array(done.scenario.start)
    z, inputs = measurements(trace), np.stack([trace["v"], trace["omega"]], axis=1)[:-1]
    moved = z.copy()
    moved[MOVED, 0] += 1.0
    P = done.scenario.estimator.initial_covariance * np.eye(3)
    told = [
        replay(Popf(RobotModel()), start, P, inputs, constant_delay(each, m)) for each in (z, moved)
    ]
    differ = np.abs(told[1].estimates - told[0].estimates).max(axis=1) > 0
    return Evidence({"later": float(np.argmax(differ) - MOVED), "m": float(m)})


def misprint(erratum: Erratum) -> Evidence:
    """The loop of Fig. 8 with one of the errata put back, and without."""
    fig8 = load("fig8")
    printed, right = (
        cost(fig8, variant, SEEDS) for variant in (Variant("", frozenset({erratum})), CORRECTED)
    )
    numbers = {"printed": printed.noisy_errors, "corrected": right.noisy_errors}
    return Evidence(
        {name: np.inf if errors is None else errors.x for name, errors in numbers.items()}
        | {"converged": float(printed.converged), "seeds": SEEDS}
    )


def claimed_covariance() -> Evidence:
    """What the filter claims, held against its errors, in the loop of `lab`."""
    scenario = load("lab", {"estimator.initial_covariance": P_0, "estimator.kind": "delayed-ekf"})
    names = ("popf", "popf-exact")
    jobs = [Job(nth(scenario, number).to_toml(), names) for number in range(SEEDS)]
    m = scenario.link.measurement_delay
    popf, exact = consistencies(names, map(judge, jobs), scenario.must_end(), m)
    high = chi_square_bounds(SEEDS)[1]
    return Evidence(
        {
            "nees": popf.nees.mean,
            "exact": exact.nees.mean,
            "high": high,
            "p0": P_0,
        }
    )


def beside_the_optimum() -> Evidence:
    """Filters on one record of `lab`, over some seeds: RMS error in x."""
    beside = ["popf", "popf-exact"]
    runs = [run("lab", {"seed": seed, "estimator.compare": beside}) for seed in range(1, SEEDS + 1)]
    rms = {
        name: float(np.mean([one.summary.compare[name].x for one in runs]))  # type: ignore[union-attr]
        for name in ("delayed-ekf", *beside)
    }
    return Evidence({"best": rms["delayed-ekf"], "popf": rms["popf"], "exact": rms["popf-exact"]})


def _misprint(erratum: Erratum) -> Claim:
    name = erratum.name.lower().replace("_", "-")
    return Claim(
        name=f"misprint-{name}",
        place=f"({erratum.equation.replace(', ', '), (')})",
        says=f"It reads `{erratum.printed}`.",
        command="laglab errata fig8",
        experiment=partial(misprint, erratum),
        got="As printed the RMS error in x is {printed:.2g} m over {seeds:.0f} seeds with noise, "
        "as corrected {corrected:.2g} m.",
        holds=never,
        nearly=lambda n: bool(n["converged"]) and n["printed"] < n["corrected"] + CHANCE,
        then=Verdict.HARMLESS,
        why=f"As it is derived it reads `{erratum.used}`.",
    )


CLAIMS = (
    Claim(
        name="kalman",
        place="section 3.2, (24)",
        says="A measurement's update is that of the Kalman filter, its gain multiplied by M⋆.",
        command="laglab run fig8 -m 0",
        experiment=without_delay,
        got="With m = 0, where M⋆ = I, the filter and the EKF differ by {apart:.0e} at most.",
        holds=lambda n: n["apart"] < 1e-9,
    ),
    Claim(
        name="noises",
        place="section 3.2, (20)",
        says="The error before the correction at k holds the measurement noises v_{s+1} … v_k.",
        command="laglab run fig8",
        experiment=first_felt,
        got="A measurement of tick j first shows in the estimate of tick j + {later:.0f}, so "
        "before the correction at k nothing later than v_{{k−1−m}} can be in it (m = {m:.0f}).",
        holds=lambda n: n["later"] == 0,
        why="The corrections at s … k − 1 use what was sampled m ticks before each: "
        "v_{s−m} … v_{k−1−m}.",
    ),
    *(_misprint(erratum) for erratum in Erratum),
    Claim(
        name="covariance",
        place="section 3.2, (19) to (23)",
        says="The noise in an extrapolated measurement is white, so that (22) holds, and P is the "
        "covariance of the error.",
        command="laglab consistency lab --p0 1e-2 --seeds 20",
        experiment=claimed_covariance,
        got="At P_0 = {p0:g} I the filter's NEES averages {nees:.1f}, where 3 would be true and "
        "{high:.1f} the limit; with the true cross-covariance it is {exact:.1f}.",
        holds=lambda n: n["nees"] < n["high"],
        why="Measurements that are on their way at the same time share the errors of those before.",
    ),
    Claim(
        name="optimal",
        place="sections 1 and 3.2",
        says="The filter predicts the state optimally, in the sense of its mean square error.",
        command="laglab run lab --estimator delayed-ekf --estimator popf --estimator popf-exact",
        experiment=beside_the_optimum,
        got="On the same records of `lab` its RMS error in x is {popf:.2g} m; that of an EKF which "
        "takes each measurement where it belongs is {best:.2g} m, with the true "
        "cross-covariance {exact:.2g} m.",
        holds=lambda n: n["popf"] < 1.01 * n["best"],
        why="Its innovations are not white, so they hold more than it takes from them.",
    ),
)
