"""The same by hand: what one would write without laglab, and the least that could do it.

The `loop` by hand needs FMPy, and is not listed here: who asks for help does without.
"""

from laglab.bench.by_hand.echo import Link, seconds_per_echo, tick_sizes
from laglab.bench.by_hand.many import Situation, many_by_hand

__all__ = ["Link", "Situation", "many_by_hand", "seconds_per_echo", "tick_sizes"]
