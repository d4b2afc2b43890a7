"""The paper's figures with simulated content: 4 to 8."""

from __future__ import annotations

from functools import partial

import numpy as np
from msgspec.structs import astuple

from laglab.interface import run
from laglab.results.numbers import AXES, goal_errors, last_second, robot_pose
from laglab.results.run import Run
from laglab.studies.reproduce.claim import Claim, Evidence, Numbers
from laglab.studies.reproduce.showing import M, N, png

SEEDS = range(1, 7)
ENDLESS = 1e3
"""[m/s] A robot that is faster than that has lost its goal."""


def ended(done: Run) -> dict[str, float]:
    """Over the last second."""
    trace = done.trace
    rho, theta_error = goal_errors(robot_pose(trace), done.scenario.goal)
    second = last_second(trace["time"])
    return {
        "rho": float(rho[second].max()),
        "theta": float(np.abs(theta_error[second]).max()),
        "v": float(np.nanmax(np.abs(trace["v"][second]))),
        "omega": float(np.nanmedian(np.abs(trace["omega"][second]))),
    }


def as_drawn(name: str) -> Evidence:
    """A run of one of the paper's scenarios."""
    done = run(name)
    return Evidence(ended(done), png(done.figure()))


def with_and_without_limits() -> Evidence:
    """Fig. 5, limited as it seems to be; and without any limits."""
    limited, free = run("fig5"), run("fig4", {N: 10, M: 20})
    fastest = float(np.nanmax(np.abs(free.trace["v"])))
    return Evidence({**ended(limited), "fastest": fastest}, png(limited.figure()))


def against_the_ekf() -> Evidence:
    """Fig. 8 over some seeds: by how much the EKF deviates more, at least, on each axis."""
    runs = [run("fig8", {"seed": seed}) for seed in SEEDS]
    popf, ekf = (
        np.array([astuple(of) for one in runs if (of := one.summary.compare[kind])])
        for kind in ("popf", "ekf")
    )
    least = dict(zip(AXES, (ekf / popf).min(axis=0).tolist(), strict=True))
    return Evidence({**least, "seeds": len(SEEDS)}, png(runs[0].figure()))


def ekf_drives() -> Evidence:
    """The loop of Fig. 6 with the EKF in the filter's place."""
    return Evidence(ended(run("fig6", {"estimator.kind": "ekf"})))


def still(n: Numbers) -> bool:
    """At the goal, and at rest."""
    return max(n["rho"], n["theta"], n["v"], n["omega"]) < 1e-3


def _converges(name: str, place: str, says: str) -> Claim:
    return Claim(
        name=name,
        place=place,
        says=says,
        command=f"laglab run {name}",
        experiment=partial(as_drawn, name),
        got="In the last second ρ < {rho:.0e} m, |θ| < {theta:.0e} rad, |v| < {v:.0e} m/s.",
        holds=still,
    )


CLAIMS = (
    _converges("fig4", "Fig. 4, section 4.2", "Without delay pose and speeds go to 0."),
    Claim(
        name="fig5",
        place="Fig. 5, section 4.2",
        says="With n = 10 and m = 20 and no filter x and y tend to 0, θ does not, and ω tends to "
        "1.7 rad/s.",
        command="laglab run fig5",
        experiment=with_and_without_limits,
        got="With v limited to 2 m/s and ω to 1.7 rad/s ρ is below {rho:.2g} m in the last second, "
        "|θ| still reaches {theta:.2g} rad, and |ω| is at {omega:.2g} rad/s, to either side. "
        "Without limits the robot diverges, at {fastest:.0e} m/s.",
        holds=lambda n: n["fastest"] < ENDLESS,
        nearly=lambda n: n["rho"] < 0.5 and n["theta"] > 0.5 and abs(n["omega"] - 1.7) < 0.1,
        provided="limits of about 2 m/s and 1.7 rad/s, which the paper does not mention",
        why="`laglab run fig4 -n 10 -m 20` is the loop without them.",
    ),
    _converges("fig6", "Fig. 6, section 4.2", "With n = 10, m = 20 the filter makes it stable."),
    _converges("fig7", "Fig. 7, section 4.2", "Likewise from another start, n = 15, m = 25."),
    Claim(
        name="fig8",
        place="Fig. 8, section 5",
        says="With noise the filter's estimate deviates less than the EKF's, in x, y and θ.",
        command="laglab run fig8",
        experiment=against_the_ekf,
        got="Over {seeds:.0f} seeds the EKF has at least {x:.0f} times the RMS error in x, "
        "{y:.0f} times in y and {theta:.0f} times in θ.",
        holds=lambda n: min(n["x"], n["y"], n["theta"]) > 1,
    ),
    Claim(
        name="ekf",
        place="section 5",
        says="That the estimate deviates less explains why the loop is stable with the filter.",
        command="laglab run fig6 --estimator ekf",
        experiment=ekf_drives,
        got="With the EKF in the loop of Fig. 6, without noise, the robot stops at ρ = {rho:.2g} m "
        "and |θ| = {theta:.2g} rad.",
        holds=lambda n: not still(n),
    ),
)
