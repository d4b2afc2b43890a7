"""What a link does to frames besides delaying them by n or m ticks: the values, checked."""

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from pydantic import ConfigDict, Field, FiniteFloat

Probability = Annotated[FiniteFloat, Field(ge=0, le=1)]
NotNegative = Annotated[FiniteFloat, Field(ge=0)]
Seconds = NotNegative
STRICT = ConfigDict(extra="forbid")


@dataclass(frozen=True)
class ExtraDelay:
    """A random delay on top of the fixed one, never below 0; `mean` and `spread` in seconds.

    `spread` is the half width of `uniform` and the standard deviation of `normal`; `constant` and
    `exponential` have none.
    """

    __pydantic_config__ = STRICT

    distribution: Literal["constant", "uniform", "normal", "exponential"]
    mean: Seconds
    spread: Seconds = 0.0

    def draw(self, rng: np.random.Generator) -> float:
        """One delay [s]."""
        match self.distribution:
            case "constant":
                delay = self.mean
            case "uniform":
                delay = self.mean + self.spread * (2 * rng.random() - 1)
            case "normal":
                delay = rng.normal(self.mean, self.spread)
            case "exponential":
                delay = rng.exponential(self.mean)
        return max(0.0, delay)


@dataclass(frozen=True)
class Burst:
    """Gilbert-Elliott losses: a chain of two states that moves once a frame.

    E. N. Gilbert, "Capacity of a burst-noise channel", 1960; E. O. Elliott, 1963.
    """

    __pydantic_config__ = STRICT

    good_to_bad: Probability
    bad_to_good: Probability
    loss_good: Probability = 0.0
    loss_bad: Probability = 1.0


@dataclass(frozen=True)
class Impairments:
    """One direction of the link. The default does nothing."""

    __pydantic_config__ = STRICT

    extra_delay: ExtraDelay | None = None
    loss: Probability = 0.0
    burst: Burst | None = None
    reorder: Probability = 0.0
    """Chance that a frame is held back by `reorder_by` [s], so that later ones overtake it."""
    reorder_by: Seconds = 0.03
    duplicate: Probability = 0.0
    bit_error_rate: Probability = 0.0
    bandwidth: Annotated[FiniteFloat, Field(gt=0)] | None = None
    """[bit/s]; frames wait for those before them."""
    queue: Annotated[int, Field(gt=0)] = 4096
    """[bytes] that may wait for the bandwidth; what does not fit is dropped (drop-tail)."""
    outages: tuple[tuple[Seconds, Seconds], ...] = ()
    """(start, duration) [s]: nothing passes."""


IDEAL = Impairments()
