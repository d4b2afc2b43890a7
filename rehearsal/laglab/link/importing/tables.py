"""netem's tables: how delays are distributed, as `tc qdisc … netem delay … distribution` has it."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from laglab.link.errors import LinkFileError
from laglab_gateway import ExtraDelay

SCALE = 8192
"""What stands in a table for one standard deviation."""
QUANTILES = 65
MOST = 2**15
"""Numbers in a table are smaller: netem has 16 bits for each."""
LARGEST = 1 << 20
"""[byte] No table is larger: netem takes 16,384 numbers."""


def numbers_of(text: str) -> list[int] | None:
    """What stands in it besides comments, if it is nothing but whole numbers."""
    words = [word for line in text.splitlines() for word in line.split("#")[0].split()]
    try:
        return [int(word) for word in words] or None
    except ValueError:
        return None


def is_table(numbers: Sequence[int]) -> bool:
    """Whether these may be one: a table rises, and has delays below the mean."""
    rises = list(numbers) == sorted(numbers)
    return len(numbers) > 1 and rises and -MOST <= numbers[0] < 0 <= numbers[-1] < MOST


def read_table(path: Path, mean: float | None, spread: float | None) -> ExtraDelay | None:
    """The distribution that netem draws from, told these [s]; None when the file is no table.

    Raises LinkFileError.
    """
    try:
        with path.open("rb") as file:
            text = file.read(LARGEST + 1).decode()
        numbers = numbers_of(text) if len(text) <= LARGEST else None
    except (OSError, ValueError):
        return None
    if numbers is None or not is_table(numbers):
        return None
    if mean is None or spread is None:
        raise LinkFileError(
            f"{path} is a table of netem's: say --mean and --spread too, as you tell netem after "
            "`delay`"
        )
    shares = np.linspace(0.0, 1.0, QUANTILES)
    delays = mean + spread * np.quantile(np.array(numbers) / SCALE, shares)
    return ExtraDelay("table", quantiles=tuple(np.round(np.maximum(delays, 0.0), 7).tolist()))
