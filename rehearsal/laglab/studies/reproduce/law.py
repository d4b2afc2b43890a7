"""Claims on the robot and its law: sections 2.1 and 2.2."""

from __future__ import annotations

import numpy as np

from laglab.interface import run
from laglab.results.figures import plain, sheet
from laglab.results.numbers import HEADING_BOUND, goal_errors, robot_pose
from laglab.scenario import load
from laglab.studies.reproduce.claim import Claim, Evidence
from laglab.studies.reproduce.showing import N, on_grid, png
from laglab_control import PolarLaw, delay_margin
from laglab_fmu import RobotParameters

STARTS = 12
ONE_SECOND = 100
DELAYS = range(15)


def right_wheel_alone() -> Evidence:
    """It turns by 1 rad/s for a second, the left one stands."""
    from laglab_fmu import Robot  # loads FMPy

    robot = RobotParameters(noise=False)
    with Robot.open(3, robot) as body:
        for _ in range(ONE_SECOND):
            reading = body.step(0.0, 1.0)
    printed = {"v_printed": 1 / 2, "omega_printed": -1 / robot.track}
    return Evidence({"v": reading.v, "omega": reading.omega, **printed})


def many_starts() -> Evidence:
    """The law from many starts, without delay, filter and noise."""
    runs = on_grid("law", "fig4", {}, STARTS)
    settled = runs.number("settled_s")
    return Evidence(
        {
            "runs": STARTS,
            "converged": float(runs.number("converged").sum()),
            "slowest": float(np.nanmax(settled)),
        }
    )


def late_commands() -> Evidence:
    """Fig. 4 with its commands later and later."""
    swing, converged = [], []
    for n in DELAYS:
        done = run("fig4", {N: n})
        _, theta_error = goal_errors(robot_pose(done.trace), done.scenario.goal)
        swing.append(float(np.abs(theta_error[-ONE_SECOND:]).max()))
        converged.append(done.summary.converged)
    margin = delay_margin(PolarLaw(), load("fig4").sample_time).approach
    largest = converged.index(False) - 1
    return Evidence({"largest": largest, "margin": margin}, _swings(swing, margin))


def _swings(swing: list[float], margin: int) -> bytes:
    with plain():
        figure = sheet(7, 3)
        axes = figure.subplots()
        axes.semilogy(DELAYS, swing, "o-")
        axes.axvline(margin + 0.5, color="black", label="delay margin, computed")
        axes.axhline(HEADING_BOUND, color="grey", linestyle=":", label="converged below")
        axes.set(xlabel="n + m [ticks]", ylabel="largest |θ| of the last second [rad]")
        axes.legend()
        axes.grid(alpha=0.3)
    return png(figure)


def the_same_later() -> Evidence:
    """Fig. 6's loop beside Fig. 4's, n ticks later."""
    n = load("fig6").link.command_delay
    late, prompt = (robot_pose(run(name).trace) for name in ("fig6", "fig4"))
    apart = float(np.abs(late[n:] - prompt[: len(prompt) - n]).max())
    return Evidence({"apart": apart, "n": n})


CLAIMS = (
    Claim(
        name="kinematics",
        place="section 2.1, (1)",
        says="Speeds of the body from those of the wheels: v = (ω_L + ω_R)/2, ω = (ω_L − ω_R)/L.",
        command="laglab fmu build --out fmus",
        experiment=right_wheel_alone,
        got="The right wheel alone, at 1 rad/s, drives the robot at {v:.3g} m/s and turns it by "
        "{omega:.3g} rad/s; as printed it would be {v_printed:.3g} and {omega_printed:.3g}.",
        holds=lambda n: abs(n["v"] - n["v_printed"]) + abs(n["omega"] - n["omega_printed"]) < 1e-6,
        why="The wheel radius is missing, and the sign makes θ clockwise, against (3).",
    ),
    Claim(
        name="law",
        place="section 2.1, (2), (4)",
        says="The law makes the robot that nothing delays asymptotically stable, also sampled.",
        command="laglab run fig4 --start 2,1,-1.5",
        experiment=many_starts,
        got="{converged:.0f} of {runs:.0f} runs from starts within 5 m converge, the slowest after "
        "{slowest:.1f} s.",
        holds=lambda n: n["converged"] == n["runs"],
    ),
    Claim(
        name="delay",
        place="section 2.2",
        says="With late commands and measurements the law (4) no longer ensures stability.",
        command="laglab run fig4 -n 10",
        experiment=late_commands,
        got="The robot still settles {largest:.0f} ticks late and swings on from the next one on; "
        "the delay margin computed from the linearised loop is {margin:.0f} ticks.",
        holds=lambda n: n["largest"] == n["margin"] < 30,
        why="The paper does not say how much the law bears. Its figures are 30 and 40 ticks late.",
    ),
    Claim(
        name="prediction",
        place="sections 2.2 and 3",
        says="A command made for the state predicted for its arrival makes the loop stable again.",
        command="laglab run fig6",
        experiment=the_same_later,
        got="Without noise the way of Fig. 6 is that of Fig. 4, {n:.0f} ticks later, to "
        "{apart:.0e} m and rad.",
        holds=lambda n: n["apart"] < 1e-3,
    ),
)
