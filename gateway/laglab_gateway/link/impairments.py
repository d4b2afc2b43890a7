"""What a link does to frames besides delaying them by n or m ticks: the values, checked."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from laglab_gateway.values import Positive, Probability, Seconds, Whole, checked, described, saying


@checked
class ExtraDelay:
    """A random delay on top of the fixed one, never below 0."""

    distribution: Annotated[
        Literal["constant", "uniform", "normal", "exponential"],
        described("-", "How it scatters: `constant`, `uniform`, `normal` or `exponential`."),
    ] = "constant"
    mean: Annotated[Seconds, described("s", "The mean of the distribution.")] = 0.0
    spread: Annotated[
        Seconds,
        described("s", "Half the width of `uniform`, the standard deviation of `normal`."),
    ] = 0.0

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
