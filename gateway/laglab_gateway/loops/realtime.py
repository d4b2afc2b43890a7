"""The gateway's loop on the wall clock: ticks happen when they are due, answered or not.

The deadline of tick k is start + k Ts / speed, never a sum of sleeps, so lateness does not add up.
What has arrived by a deadline counts; the link's own delay adds to n and m, and the stamps tell.
"""

from laglab_gateway.core import Gateway
from laglab_gateway.loops.conversation import Conversation
from laglab_gateway.loops.surroundings import Served, Surroundings, served
from laglab_gateway.record.lateness import Lateness
from laglab_gateway.record.rows import TimingRow


def serve_realtime(gateway: Gateway, around: Surroundings, period: float) -> Served:
    """Run a gateway to its last tick, one tick every `period` [s] of the clock `around.now`.

    Between a deadline and the tick's first byte nothing is done that can be done at another time:
    the plant has been stepped, files wait.

    Raises:
        StationSilentError: the station never came, or fell silent for longer than allowed.
        SettingsError: the station ticks at another pace.
        EndpointError: the link itself broke.
        TraceError: what happened could not be kept.
    """
    conversation = Conversation(gateway, around)
    lateness = gateway.lateness = Lateness(period)
    with conversation.run():
        conversation.wait_for_station()
        start = conversation.now()
        while gateway.outcome is None:
            deadline = start + gateway.tick * period
            late = conversation.now() - deadline
            if lateness.add(late):
                gateway.announce(f"cannot keep up: tick {gateway.tick} is {late:.3f} s late")
            conversation.send(gateway.open_tick())
            gateway.settle()
            conversation.catch_up()
            conversation.ask_time()
            conversation.check_silence()
            answered = _listen_until(deadline + period, gateway, conversation)
            answer = None if answered is None else answered - deadline - late
            around.recorder.timing(TimingRow(gateway.tick, late, answer))
            conversation.finish_tick()
    return served(gateway)


def _listen_until(deadline: float, gateway: Gateway, conversation: Conversation) -> float | None:
    """Take what arrives before the deadline, and, where that is past, what is there already.
    Returns when this tick's answer came; None when it did not."""
    answered = None
    left = deadline - conversation.now()
    while True:
        conversation.listen(max(left, 0))
        if answered is None and gateway.answered:
            answered = conversation.now()
        left = deadline - conversation.now()
        if left <= 0:
            return answered
