"""What the benches measure, by hand: as one would write it without laglab, and the least that does.

`loop` needs FMPy and so is not imported here: `laglab bench --help` does without.
"""

from laglab.bench.by_hand.echo import Link, seconds_per_echo, tick_sizes
from laglab.bench.by_hand.many import Situation, many_by_hand

__all__ = ["Link", "Situation", "many_by_hand", "seconds_per_echo", "tick_sizes"]
