"""What a law must keep: `laglab_control.Law`, a row each."""

import math
from collections.abc import Iterator, Mapping

import numpy as np

from laglab.check.finding import INTERFACE, Check, need
from laglab_control import Law, Way

GOAL = (0.5, -0.25, 0.3)
STEPS = 200


def _poses() -> Iterator[Way[float]]:
    """All over the plane, and where formulas break: at the goal itself, and turned many times."""
    yield Way(*GOAL)
    yield Way(GOAL[0], GOAL[1], GOAL[2] + 4 * np.pi)
    yield Way(0.0, 0.0, 0.0)
    random = np.random.default_rng(1)
    for scale in (1e-9, 1e-3, 1.0, 30.0, 900.0):
        for x, y, theta in random.uniform(-1, 1, (40, 3)).tolist():
            yield Way(GOAL[0] + scale * x, GOAL[1] + scale * y, 7 * theta)


def interface(law: Law) -> str:
    """drive, and what it answers."""
    v, omega, _ = law.drive(Way(1.0, 2.0, 0.5), 0.1, None)
    return f"v = {v:.3g} m/s, ω = {omega:.3g} rad/s at (1, 2, 0.5)"


def finite(law: Law) -> str:
    """Finite speeds wherever the robot is, at the goal too."""
    for time in (0.0, 0.1, 1e4):
        for pose in _poses():
            v, omega, _ = law.drive(pose, time, None)
            need(math.isfinite(v) and math.isfinite(omega), f"v = {v}, ω = {omega} at {pose}")
    return "all over the plane, and at the goal itself"


def deterministic(law: Law) -> str:
    """The same at the same pose and time, whatever it was asked before."""
    asked = [(pose, 0.01 * number) for number, pose in enumerate(_poses()) if pose[:2] != GOAL[:2]]
    once = [tuple(law.drive(pose, time, None))[:2] for pose, time in asked]
    again = [tuple(law.drive(pose, time, None))[:2] for pose, time in reversed(asked)][::-1]
    for (pose, time), first, second in zip(asked, once, again, strict=True):
        need(first == second, f"twice differently at {pose} and t = {time:g} s: {first}, {second}")
    return "each pose twice, in another order"


def memory(law: Law) -> str:
    """All that it remembers is in what it answers: with an older memory it is as it was then."""
    told: object = None
    memories: list[object] = []
    answers: list[tuple[float, float]] = []
    for k in range(STEPS):
        pose = Way(GOAL[0] - 1 + k / STEPS, GOAL[1], GOAL[2])
        memories.append(told)
        v, omega, told = law.drive(pose, 0.01 * k, told)
        answers.append((v, omega))
    for k in range(STEPS):
        pose = Way(GOAL[0] - 1 + k / STEPS, GOAL[1], GOAL[2])
        v, omega, _ = law.drive(pose, 0.01 * k, memories[k])
        need((v, omega) == answers[k], f"step {k}, asked again with its memory, is another one")
    return f"{STEPS} steps, and all again with the memory of then"


CHECKS: Mapping[str, Check[Law]] = {
    INTERFACE: interface,
    "finite": finite,
    "deterministic": deterministic,
    "memory": memory,
}
