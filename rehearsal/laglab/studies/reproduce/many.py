"""Claims on many runs: starts, delays and P_0, section 5."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from laglab.scenario import Overrides
from laglab.studies.maps import draw_study
from laglab.studies.reproduce.claim import Claim, Evidence
from laglab.studies.reproduce.showing import P_0, M, N, on_grid, png

DELAYS = (0, 10, 25, 50)
STARTS = 3
PRIORS = (1e-4, 3e-4, 1e-3, 2e-3, 5e-3, 9e-3)
"""[m², rad²] All below R, which is 1e-2 m² and 1.8e-2 rad²."""
SEEDS = 6
WITHOUT_NOISE = "popf without noise"
WITH_NOISE = "popf with noise and goal tolerance"
NOISE = {"noise": True}
TOLERANT = {**NOISE, "law.goal_tolerance": 0.03}


def starts_and_delays(name: str, overrides: Overrides) -> Evidence:
    """The paper's filter from starts within 5 m, with n and m up to 0.5 s."""
    runs = on_grid(name, "fig6", {N: DELAYS, M: DELAYS}, STARTS, overrides)
    converged = runs.number("converged")
    numbers = {
        "runs": float(len(converged)),
        "converged": float(converged.sum()),
        "diverged": float(runs.diverged.sum()),
        "rho": float(runs.number("final_rho").max()),
        "omega": float(np.median(runs.number("max_omega"))),
    }
    return Evidence(numbers, png(draw_study(runs, ["converged"])))


def noisy() -> Evidence:
    """The same with noise: with the law as it is, and with a goal tolerance."""
    bare, tolerant = (starts_and_delays(*each) for each in (("", NOISE), (WITH_NOISE, TOLERANT)))
    numbers = {f"tolerant_{name}": value for name, value in tolerant.numbers.items()}
    return Evidence(numbers | bare.numbers, tolerant.picture)


def priors(of: Sequence[float]) -> Evidence:
    """The loop of Fig. 8, with a goal tolerance, over P_0."""
    runs = on_grid("popf, noise, goal tolerance", "fig8", {P_0: of}, SEEDS, TOLERANT, None)
    lost, p0 = runs.diverged, runs.columns[P_0]
    shares = {prior: float(lost[p0 == prior].mean()) for prior in of}
    numbers = {
        "least": shares[of[0]],
        "most": shares[of[-1]],
        "lost": min((prior for prior in of if shares[prior] > 0), default=np.inf),
        "all_lost": min((prior for prior in of if shares[prior] == 1), default=np.inf),
        "seeds": SEEDS,
    }
    return Evidence(numbers, png(draw_study(runs, ["diverged", "rms_x"])))


CLAIMS = (
    Claim(
        name="starts",
        place="section 5",
        says="From many starts and with many delays the filter always makes the loop "
        "asymptotically stable: without noise.",
        command="laglab run fig6 -n 50 -m 50 --start 2,1,-1.5",
        experiment=partial(starts_and_delays, WITHOUT_NOISE, {}),
        got="{converged:.0f} of {runs:.0f} runs of 10 s converge, n and m from 0 to 50 ticks, "
        "starts within 5 m; the farthest ends at ρ = {rho:.0e} m.",
        holds=lambda n: n["converged"] == n["runs"],
        why="As far as numbers reach: `laglab run fig6 --duration 15` lets the robot come so near "
        "that rounding decides where the goal lies, and it spins.",
    ),
    Claim(
        name="starts-noise",
        place="section 5",
        says="The same with the noise of (30).",
        command="laglab run fig8 --start 2,1,-1.5",
        experiment=noisy,
        got="{converged:.0f} of {runs:.0f} runs converge: they come within {rho:.2g} m of the goal "
        "and spin there. With a goal tolerance of 3 cm {tolerant_converged:.0f} converge; "
        "{diverged:.0f} and {tolerant_diverged:.0f} estimates diverge.",
        holds=lambda n: n["converged"] == n["runs"],
        nearly=lambda n: n["tolerant_converged"] == n["tolerant_runs"],
        provided="a goal tolerance, which the law of the paper does not have",
        why="At ρ = 0 the direction to the goal has no value, so the noise of the estimate turns "
        "the robot.",
    ),
    Claim(
        name="prior",
        place="section 5",
        says="The initial P is important for the filter to converge.",
        command="laglab run fig8 --p0 5e-3",
        experiment=partial(priors, (PRIORS[0], PRIORS[-1])),
        got="With noise, of {seeds:.0f} seeds each, the estimate diverges "
        f"at P_0 = {PRIORS[0]:g} I in {{least:.0%}}, at {PRIORS[-1]:g} I in {{most:.0%}}.",
        holds=lambda n: n["least"] == 0 < n["most"],
    ),
    Claim(
        name="prior-below-r",
        place="section 5",
        says="A P_0 smaller than R keeps the first estimates from jumping, and the filter "
        "converges.",
        command="laglab run fig8 --p0 2e-3",
        experiment=partial(priors, PRIORS),
        got="Of {seeds:.0f} seeds each, the smallest P_0 at which one diverges is {lost:g} I, and "
        "at which all do {all_lost:g} I; R is 1e-2 m², 1.8e-2 rad².",
        holds=lambda n: n["lost"] >= 1e-2,
        why="A gain above 2 sin(π/(2(2m + 1))), 0.077 at m = 20, is unstable; the first one is "
        "about P_0/(P_0 + R).",
    ),
)
