"""A plant, driven twice, each time in a process of its own: whatever it does, we are still here."""

import math
from collections.abc import Iterator
from time import perf_counter
from typing import NamedTuple

from msgspec import Struct

from laglab.errors import LaglabError
from laglab.runs.plant import open_plant
from laglab.runs.processes.answers import GaveUpError, NoAnswerError, answer_all, asked
from laglab.runs.processes.child import Tell
from laglab.scenario import Scenario
from laglab_gateway import Plant, Reading

V, OMEGA = 0.3, 0.5
"""[m/s, rad/s] It drives straight ahead for a second, and in a curve for another."""
PHASE = 1.0
"""[s]"""
STILL = 1e-6
"""[m, rad] A robot that has moved by no more has not moved."""
PATIENCE = 60.0
"""[s] A plant that has not been driven by then does not come back."""


class PlantCheckError(LaglabError):
    """A plant does not do what one must; the text says what it did."""

    exit_code = 1


class TrialOrder(Struct, frozen=True):
    """Whose plant to try."""

    scenario: str
    """As TOML."""


class Driven(NamedTuple):
    """How a plant was driven once."""

    readings: list[Reading]
    """Straight ahead for a PHASE, then in a curve for another."""
    seconds: float
    """On the wall, of both."""
    placed: bool | None
    warnings: tuple[str, ...]


class Trial(NamedTuple):
    """What a plant did."""

    start: tuple[float, float, float]
    ahead: float
    """[m] How far it came along its first heading, at V for PHASE."""
    turned: float
    """[rad] Of its heading in the curve, at OMEGA for PHASE."""
    deterministic: bool
    """Whether two of them say the same, bit by bit."""
    placed: bool | None
    """Whether it is where it was put; None: nobody can put it anywhere."""
    real_time_factor: float
    warnings: tuple[str, ...]

    @property
    def is_fine(self) -> bool:
        """Whether it can be used as it is."""
        moves = abs(self.ahead) > STILL and abs(self.turned) > STILL
        return self.deterministic and moves and self.placed is not False

    @property
    def doubt_ahead(self) -> str:
        """What a person should look at."""
        return _doubt(self.ahead, V * PHASE, "is that the speed, in m/s, and the position, in m?")

    @property
    def doubt_turned(self) -> str:
        """The same."""
        said = "is that the turning speed, in rad/s, and the heading, in rad, counter-clockwise?"
        return _doubt(self.turned, OMEGA * PHASE, said)


def _doubt(got: float, expected: float, question: str) -> str:
    if abs(got) <= STILL:
        return f": IT DOES NOT MOVE: {question}"
    return "" if 0.5 * expected < got < 2 * expected else f": {question}"


def tried(scenario: Scenario) -> Trial:
    """The scenario's plant. Raises PlantCheckError: it fails, dies or does not come back."""
    first, again = _in_a_child(scenario), _in_a_child(scenario)
    middle = len(first.readings) // 2
    before, between, after = (first.readings[k] for k in (0, middle, -1))
    along = math.cos(before.theta), math.sin(before.theta)
    return Trial(
        before[:3],
        (between.x - before.x) * along[0] + (between.y - before.y) * along[1],
        after.theta - between.theta,
        first.readings == again.readings,
        first.placed,
        2 * PHASE / first.seconds,
        first.warnings,
    )


def _in_a_child(scenario: Scenario) -> Driven:
    order = TrialOrder(scenario.to_toml())
    try:
        with asked("plant's", f"{__name__}:drive", order, PATIENCE) as answer:
            driven: Driven = answer()
    except GaveUpError as error:
        raise PlantCheckError(str(error)) from None
    except NoAnswerError as error:
        raise PlantCheckError(f"{scenario.plant.called}: {error}") from None
    return driven


def drive(order: TrialOrder, tell: Tell) -> None:
    """In the child."""
    answer_all(tell, _driven(Scenario.from_toml(order.scenario)))


def _driven(scenario: Scenario) -> Iterator[Driven]:
    ticks = max(round(PHASE / scenario.sample_time), 1)
    with open_plant(scenario) as opened:
        begun = perf_counter()
        readings = _readings(opened.plant, ticks)
        seconds = perf_counter() - begun
        placed = _placed(opened.plant) if opened.placeable else None
    yield Driven(readings, seconds, placed, opened.warnings)


def _readings(plant: Plant, ticks: int) -> list[Reading]:
    readings = [plant.read()]
    for omega in (0.0, OMEGA):
        for _ in range(ticks):
            plant.step(V, omega)
            readings.append(plant.read())
    return readings


def _placed(plant: Plant) -> bool:
    there = (0.25, -0.5, 0.75)
    plant.place(*there)
    return all(abs(a - b) < 1e-6 for a, b in zip(plant.read(), there, strict=False))
