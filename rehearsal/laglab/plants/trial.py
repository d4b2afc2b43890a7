"""A plant, driven twice in a process of its own: whatever it does there, we are still here."""

import math
import pickle
from collections.abc import Sequence
from queue import Empty, Queue
from time import perf_counter
from typing import NamedTuple

from msgspec import Struct

from laglab.errors import LaglabError
from laglab.runs.child import Inbox, Tell, started
from laglab.runs.errors import SIDE_ERRORS
from laglab.runs.plant import OpenPlant, open_plant
from laglab.runs.reports import Computed, Failed
from laglab.scenario import Scenario
from laglab_gateway import Reading

V, OMEGA = 0.3, 0.5
"""[m/s, rad/s] It drives straight ahead for a second, and in a curve for another."""
PHASE = 1.0
"""[s]"""
STILL = 1e-6
"""[m, rad] Who has moved by no more has not moved."""
PATIENCE = 60.0
"""[s] A plant that has not come so far by then does not come back."""


class PlantCheckError(LaglabError):
    """A plant does not do what one must; the text says what it did."""

    exit_code = 1


class TrialOrder(Struct, frozen=True):
    """Whose plant to try."""

    scenario: str
    """As TOML."""


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
    inbox: Inbox = Queue()
    order = TrialOrder(scenario.to_toml())
    with started("plant's", f"{__name__}:try_plant", order, inbox):
        try:
            _, report = inbox.get(timeout=PATIENCE)
        except Empty:
            raise PlantCheckError(
                f"{scenario.plant.called} does not come back: {PATIENCE:g} s for "
                f"{2 * PHASE:g} s of its time were not enough"
            ) from None
    match report:
        case Computed(answer):
            trial: Trial = pickle.loads(answer)
            return trial
        case Failed(reason):
            raise PlantCheckError(reason)
        case other:
            raise PlantCheckError(f"{scenario.plant.called}: {getattr(other, 'how', other)}")


def try_plant(order: TrialOrder, tell: Tell) -> None:
    """In the child."""
    try:
        tell(Computed(pickle.dumps(tried_here(Scenario.from_toml(order.scenario)))))
    except SIDE_ERRORS as error:
        tell(Failed(str(error), begun=True))


def tried_here(scenario: Scenario) -> Trial:
    """In this process. Raises what `open_plant` and the plant raise."""
    ticks = max(round(PHASE / scenario.sample_time), 1)
    with open_plant(scenario) as opened:
        begun = perf_counter()
        first = _driven(opened, ticks)
        seconds = perf_counter() - begun
        placed = _placed(opened) if opened.placeable else None
    with open_plant(scenario) as again:
        same = _driven(again, ticks) == first
    before, between, after = first[0], first[ticks], first[-1]
    along = math.cos(before.theta), math.sin(before.theta)
    return Trial(
        before[:3],
        (between.x - before.x) * along[0] + (between.y - before.y) * along[1],
        after.theta - between.theta,
        same,
        placed,
        2 * ticks * scenario.sample_time / seconds,
        opened.warnings,
    )


def _driven(opened: OpenPlant, ticks: int) -> Sequence[Reading]:
    """Straight ahead, then in a curve."""
    readings = [opened.plant.read()]
    for omega in (0.0, OMEGA):
        for _ in range(ticks):
            opened.plant.step(V, omega)
            readings.append(opened.plant.read())
    return readings


def _placed(opened: OpenPlant) -> bool:
    there = (0.25, -0.5, 0.75)
    opened.plant.place(*there)
    return all(abs(a - b) < 1e-6 for a, b in zip(opened.plant.read(), there, strict=False))
