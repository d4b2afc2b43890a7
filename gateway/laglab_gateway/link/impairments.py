"""What a link does to frames besides delaying them by n or m ticks: the values, checked."""

import math
from itertools import pairwise
from statistics import NormalDist
from typing import Annotated, Literal

import numpy as np
from pydantic import AfterValidator, Field, ValidationInfo

from laglab_gateway.values import (
    Number,
    Positive,
    Probability,
    Seconds,
    Whole,
    checked,
    described,
    saying,
)


def _of_a_table(quantiles: tuple[float, ...], about: ValidationInfo) -> tuple[float, ...]:
    if about.data.get("distribution") == "table" and len(quantiles) < 2:
        raise ValueError("a table has two delays or more")
    if any(later < earlier for earlier, later in pairwise(quantiles)):
        raise ValueError("must rise from one to the next")
    return quantiles


@checked
class ExtraDelay:
    """A random delay on top of the fixed one, never below 0."""

    distribution: Annotated[
        Literal["constant", "uniform", "normal", "exponential", "table"],
        described(
            "-",
            "How it scatters: `constant`, `uniform`, `normal`, `exponential`, or by a `table`.",
        ),
    ] = "constant"
    mean: Annotated[
        Seconds, described("s", "The mean of the distribution; is added to a table's delays.")
    ] = 0.0
    spread: Annotated[
        Seconds,
        described("s", "Half the width of `uniform`, the standard deviation of `normal`."),
    ] = 0.0
    quantiles: Annotated[
        tuple[Seconds, ...],
        AfterValidator(_of_a_table),
        Field(validate_default=True),
        described(
            "s",
            "Of a `table`: the delays at equal steps of probability, from the least to the most.",
        ),
    ] = ()
    correlation: Annotated[
        Number,
        Field(ge=0, lt=1),
        described(
            "1", "How much a frame's delay tells of the next one's: that of their normal scores."
        ),
    ] = 0.0

    def draw(self, rng: np.random.Generator) -> float:
        """One delay [s], whatever the last one was."""
        match self.distribution:
            case "constant":
                delay = self.mean
            case "uniform":
                delay = self.mean + self.spread * (2 * rng.random() - 1)
            case "normal":
                delay = rng.normal(self.mean, self.spread)
            case "exponential":
                delay = rng.exponential(self.mean)
            case "table":
                delay = self.at(rng.random())
        return max(0.0, delay)

    def at(self, share: float) -> float:
        """The delay [s] within which such a share stays, above 0 and below 1."""
        match self.distribution:
            case "constant":
                delay = self.mean
            case "uniform":
                delay = self.mean + self.spread * (2 * share - 1)
            case "normal":
                delay = self.mean + self.spread * NormalDist().inv_cdf(share)
            case "exponential":
                delay = -self.mean * math.log1p(-share)
            case "table":
                place = share * (len(self.quantiles) - 1)
                known = np.arange(len(self.quantiles))
                delay = self.mean + float(np.interp(place, known, self.quantiles))
        return max(0.0, delay)


@checked
class Burst:
    """Gilbert-Elliott losses: a chain of two states that moves once a frame.

    E. N. Gilbert, "Capacity of a burst-noise channel", 1960; E. O. Elliott, 1963.
    """

    good_to_bad: Annotated[
        Probability, described("1", "Chance, at each frame, that the good state turns bad.")
    ] = 0.0
    bad_to_good: Annotated[
        Probability, described("1", "Chance, at each frame, that the bad state turns good.")
    ] = 1.0
    loss_good: Annotated[
        Probability, described("1", "Chance that a frame is lost in the good state.")
    ] = 0.0
    loss_bad: Annotated[
        Probability, described("1", "Chance that a frame is lost in the bad state.")
    ] = 1.0


@checked
class Impairments:
    """What one direction of the link does besides the fixed delay. The default does nothing."""

    extra_delay: Annotated[
        ExtraDelay | None, described("-", "A random delay on top of the fixed one.")
    ] = None
    loss: Annotated[Probability, described("1", "Chance that a frame is lost, each by itself.")] = (
        0.0
    )
    burst: Annotated[Burst | None, described("-", "Losses that come in bursts.")] = None
    reorder: Annotated[
        Probability, described("1", "Chance that a frame is held back, so that later ones pass it.")
    ] = 0.0
    reorder_by: Annotated[Seconds, described("s", "How long such a frame is held back.")] = 0.03
    duplicate: Annotated[Probability, described("1", "Chance that a frame comes twice.")] = 0.0
    bit_error_rate: Annotated[
        Probability,
        described("1", "Chance of each bit to be flipped, which the checksum nearly always finds."),
    ] = 0.0
    bandwidth: Annotated[
        Positive | None,
        described("bit/s", "How much passes: frames wait for those before them."),
    ] = None
    queue: Annotated[
        Whole,
        Field(gt=0),
        described("byte", "How much may wait for the bandwidth; what does not fit is dropped."),
    ] = 4096
    outages: Annotated[
        tuple[tuple[Seconds, Seconds], ...],
        saying("a list of [start, duration], each 0 or more"),
        described("s", "When nothing passes: a list of [start, duration]."),
    ] = ()

    @property
    def reads_bytes(self) -> bool:
        """Whether what becomes of a frame depends on its length or contents."""
        return self.bandwidth is not None or self.bit_error_rate > 0


IDEAL = Impairments()
