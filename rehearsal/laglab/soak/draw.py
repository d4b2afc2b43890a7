"""The situation of a turn, drawn."""

from collections.abc import Sequence
from typing import TypeVar

import numpy as np

from laglab.scenario import load, shipped_names
from laglab.scenario.overrides import Overrides
from laglab.soak.turn import Blow, Signal, Strangers, Transport, Turn
from laglab_control import ESTIMATORS

T = TypeVar("T")

SIMULATED = (20.0, 150.0)
"""[s] of a run in lock-step."""
REAL = (2.0, 5.0)
"""[s] by the clock, of a run in real time."""
UDP_STRANGERS: tuple[Strangers, ...] = (
    "garbage",
    "foreign frames",
    "requests",
    "bad signatures",
    "an impostor",
)
SERIAL_STRANGERS = UDP_STRANGERS[:-1]
"""On a line nobody can tell one sender from another."""
SIGNALS: tuple[Signal, ...] = ("SIGKILL", "SIGKILL", "SIGTERM", "SIGINT", "SIGSTOP")
SPEEDS = (0.5, 1.0, 2.0, 4.0)
MOST_HELD = 20
"""[ticks] What play-out adds to a delay."""
MOST_PLANNED = 100
"""[ticks]"""


def generator(seed: int, number: int) -> np.random.Generator:
    """Each turn has its own, so that it can be drawn without those before it."""
    return np.random.default_rng((seed, number))


def draw(rng: np.random.Generator, number: int) -> Turn:
    """The turn of that number; all of it comes from `rng`."""
    transport: Transport = "serial" if _by_chance(rng, 0.4) else "udp"
    blow = _blow(rng) if _by_chance(rng, 0.5) else None
    strangers = _strangers(rng, transport, blow) if _by_chance(rng, 0.5) else ()
    base = _one_of(rng, shipped_names())
    return Turn(
        number=number,
        base=base,
        overrides={**_pace(rng), **_robot(rng, base), **_station(rng), **_link(rng)},
        transport=transport,
        signed=_by_chance(rng, 0.5),
        blow=blow,
        strangers=strangers,
        rate=float(10 ** rng.uniform(1.5, 3.3)) if strangers else 0.0,
    )


def _by_chance(rng: np.random.Generator, chance: float) -> bool:
    return bool(rng.random() < chance)


def _one_of(rng: np.random.Generator, what: Sequence[T]) -> T:
    return what[int(rng.integers(len(what)))]


def _blow(rng: np.random.Generator) -> Blow:
    signal: Signal = _one_of(rng, SIGNALS)
    early = _by_chance(rng, 0.2)
    return Blow(
        side=_one_of(rng, ("gateway", "controller")),
        signal=signal,
        after=float(rng.uniform(0.0, 2.0)),
        early=early,
        again=signal == "SIGKILL" and not early and _by_chance(rng, 0.6),
    )


def _strangers(
    rng: np.random.Generator, transport: Transport, blow: Blow | None
) -> tuple[Strangers, ...]:
    """A few of them. With a blow no impostor: while no station is heard from, it would be one."""
    of = UDP_STRANGERS if transport == "udp" and blow is None else SERIAL_STRANGERS
    chosen = rng.choice(len(of), size=int(rng.integers(1, len(of) + 1)), replace=False)
    return tuple(of[i] for i in sorted(chosen))


def _pace(rng: np.random.Generator) -> Overrides:
    if _by_chance(rng, 0.5):
        return {"pace": "lockstep", "duration": round(float(rng.uniform(*SIMULATED)), 2)}
    speed = _one_of(rng, SPEEDS)
    duration = round(speed * float(rng.uniform(*REAL)), 2)
    return {"pace": "realtime", "speed": speed, "duration": duration}


def _robot(rng: np.random.Generator, base: str) -> Overrides:
    robot: dict[str, object] = {
        "seed": int(rng.integers(2**31)),
        "noise": _by_chance(rng, 0.7),
        "start": [round(float(each), 3) for each in rng.uniform(-4, 4, 3)],
        "plant.fmi": _one_of(rng, (2, 3)),
        "plant.integration": _one_of(rng, ("euler", "exact")),
    }
    if load(base).plant.has_two_wheels:
        robot["plant.wheel_radius_error"] = round(float(rng.uniform(-0.1, 0.1)), 3)
    if _by_chance(rng, 0.2):
        by = [round(float(each), 2) for each in rng.uniform(-0.5, 0.5, 3)]
        robot["plant.event"] = [{"at": 1.0, "by": by}]
    return robot


def _station(rng: np.random.Generator) -> Overrides:
    compared = [name for name, kind in ESTIMATORS.items() if kind.predicts and rng.random() < 0.1]
    return {
        "estimator.kind": _one_of(rng, list(ESTIMATORS)),
        "estimator.guard": _by_chance(rng, 0.5),
        "estimator.compare": compared,
        "estimator.initial_covariance": float(10 ** rng.uniform(-6, -3)),
    }


def _link(rng: np.random.Generator) -> Overrides:
    link: dict[str, object] = {}
    for direction, longest in (("command", 20), ("measurement", 40)):
        delay = int(rng.integers(longest + 1))
        link[f"link.{direction}_delay"] = delay
        if _by_chance(rng, 0.5):
            drawn = _impairments(rng)
            link |= {f"link.{direction}.{key}": value for key, value in drawn.items()}
        if _by_chance(rng, 0.2):
            link[f"link.playout.{direction}"] = delay + int(rng.integers(1, MOST_HELD))
    if _by_chance(rng, 0.3):
        link["link.plan"] = int(rng.integers(1, MOST_PLANNED))
    if _by_chance(rng, 0.3):
        link["link.event"] = [{"at": 1.0, "duration": 0.5, "link": {"loss": 1.0}}]
    return link


def _impairments(rng: np.random.Generator) -> Overrides:
    """Some of all that a link can do."""
    distribution = _one_of(rng, ("constant", "uniform", "normal", "exponential"))
    delay, spread, loss, reorder, duplicate = (float(each) for each in rng.random(5))
    possible: Overrides = {
        "extra_delay": {
            "distribution": distribution,
            "mean": 0.05 * delay,
            "spread": 0.02 * spread,
        },
        "loss": 0.3 * loss,
        "burst": {"good_to_bad": 0.02, "bad_to_good": 0.2},
        "reorder": 0.2 * reorder,
        "duplicate": 0.1 * duplicate,
        "bit_error_rate": float(10 ** rng.uniform(-6, -3.5)),
        "bandwidth": 115200.0,
        "outages": [[0.5, 0.3], [2.0, 1.0]],
    }
    return {key: value for key, value in possible.items() if _by_chance(rng, 0.3)}
