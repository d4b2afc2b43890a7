"""What a plant must keep: `laglab_gateway.Plant`, a row each."""

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.check.finding import INTERFACE, Check, need
from laglab_gateway import Plant, Reading

Array = NDArray[np.float64]
SAMPLE_TIME = 0.01
START = (0.4, -0.3, 0.6)
SEED = 5
TICKS = 200
SPEEDS = (0.5, 0.3)
"""[m/s, rad/s] Driven for TICKS; both at once, as not every robot can turn on the spot."""
SHARE = 0.25
"""The share of its way that a robot may lose to lags and slip."""


class Subject(NamedTuple):
    """Makes as many plants as a check needs, each at the start."""

    make: Callable[[], Plant]


def _read(plant: Plant) -> Array:
    reading = np.array(Reading(*plant.read()), dtype=float)
    need(bool(np.isfinite(reading).all()), f"read answers {reading.tolist()}, which is not finite")
    return reading


def _driven(plant: Plant, speeds: Sequence[float]) -> Array:
    """Readings (TICKS + 1, 8)."""
    readings = [_read(plant)]
    for _ in range(TICKS):
        plant.step(*speeds)
        readings.append(_read(plant))
    return np.array(readings)


def interface(subject: Subject) -> str:
    """read, step, place, and what they answer."""
    readings = _driven(subject.make(), SPEEDS)
    off = np.abs(readings[0, :3] - START).max()
    need(off < 1e-9, f"it begins at {readings[0, :3].tolist()}, not at its start {list(START)}")
    return f"a reading of {len(Reading._fields)} finite numbers at each of {TICKS} ticks"


def deterministic(subject: Subject) -> str:
    """The same seed, the same numbers."""
    once, again = (_driven(subject.make(), SPEEDS) for _ in range(2))
    differ = np.flatnonzero((once != again).any(axis=1))
    since = min(differ, default=0)
    need(not len(differ), f"the same seed gives other readings from tick {since} on")
    return f"two of them, seed {SEED}, to the last bit"


def still(subject: Subject) -> str:
    """Reading changes nothing."""
    plant = subject.make()
    readings = [_read(plant) for _ in range(5)]
    same = all(np.array_equal(readings[0], each) for each in readings)
    need(same, "two readings of one tick are not the same")
    return "five readings of one tick"


def placing(subject: Subject) -> str:
    """It is where it was put, at rest."""
    plant = subject.make()
    _driven(plant, SPEEDS)
    for asked in ((2.0, -1.0, 0.25), (START[0], 3.0, START[2])):
        plant.place(*asked)
        reading = _read(plant)
        at, speeds = reading[:3].tolist(), reading[6:].tolist()
        need(bool(np.abs(reading[:3] - asked).max() < 1e-9), f"place{asked}: it is at {at}")
        need(bool(np.abs(reading[6:]).max() < 1e-9), f"place{asked}: it moves, {speeds}")
    return "there, and at rest"


def units(subject: Subject) -> str:
    """v in m/s forward, ω in rad/s counter-clockwise, the pose in m and rad."""
    v, omega = SPEEDS
    readings = _driven(subject.make(), SPEEDS)
    seconds, steps = TICKS * SAMPLE_TIME, np.diff(readings[:, :3], axis=0)
    way = float((steps[:, :2] * _ahead(readings[:-1, 2])).sum())
    turned = float(steps[:, 2].sum())
    for name, is_, expected in (
        ("drives", way, v * seconds),
        ("turns by", turned, omega * seconds),
        ("says it drives at", float(readings[-1, 6]), v),
        ("says it turns at", float(readings[-1, 7]), omega),
    ):
        near = abs(is_ - expected) <= SHARE * expected
        need(near, f"at {v:g} m/s and {omega:g} rad/s it {name} {is_:.3g}, not {expected:.3g}")
    return f"{way:.2f} m and {turned:.2f} rad in {seconds:g} s at {v:g} m/s, {omega:g} rad/s"


def _ahead(theta: Array) -> Array:
    return np.stack((np.cos(theta), np.sin(theta)), axis=1)


CHECKS: Mapping[str, Check[Subject]] = {
    INTERFACE: interface,
    "deterministic": deterministic,
    "still": still,
    "placing": placing,
    "units": units,
}
