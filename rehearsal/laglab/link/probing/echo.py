"""The end that answers."""

from collections.abc import Callable

from laglab.link.probing.clock import WallClock
from laglab.link.probing.ends import Answerer
from laglab.link.probing.sizes import filler_for, real_sizes
from laglab_protocol import STATION_SYSTEM, Codec, Frame, Listener, Probe, Refusals

IDLE = 0.5
"""[s] The longest that it listens at a time."""


def echo(link: Listener, codec: Codec, tell: Callable[[str], None]) -> None:
    """Answer whoever measures this link, one at a time, until interrupted.

    Raises an EndpointError when the link is gone.
    """
    clock = WallClock()
    sender = codec.sender
    end = Answerer(filler_for(sender, real_sizes(sender).measurement))
    refusals = Refusals(clock() * 1e-9)
    while True:
        frames = link.listen(end.wait(clock(), IDLE))
        now = clock()
        for probe in map(_probe_of, frames):
            if probe is None or not end.is_for(probe, now):
                continue
            link.link.accept_peer()
            if end.hear(probe, now):
                tell(f"measured from now on, {1e6 / max(probe.interval_us, 1):.4g} frames a second")
        while (said := end.say(clock())) is not None:
            link.link.offer(sender.frame(said))
        if ended := end.take_over(now):  # what came since is still to be read
            link.link.leave_peer()  # whoever measures next is no stranger beside it
            tell(f"no longer measured: {ended.heard} frames came, {ended.said} were sent")
        for line in refusals.news([link], clock() * 1e-9):
            tell(f"warning: {line}")


def _probe_of(frame: Frame) -> Probe | None:
    of_the_station = frame.system == STATION_SYSTEM
    return frame.message if of_the_station and isinstance(frame.message, Probe) else None
