"""The gateway's loop in simulation time: no tick passes without the station's command for it."""

from collections.abc import Callable

from laglab_gateway.core import Gateway
from laglab_gateway.loops.conversation import Conversation, Link, Patience
from laglab_gateway.loops.watch import Watch
from laglab_gateway.record.recorder import Recorder
from laglab_gateway.side import Outcome
from laglab_protocol import EndReason


def serve_lockstep(
    gateway: Gateway,
    endpoint: Link,
    recorder: Recorder,
    patience: Patience,
    progress: Callable[[int], None],
    watch: Watch | None = None,
) -> Outcome:
    """Run a gateway to its last tick; `progress` is told of each tick that is over.

    Those who `watch` are looked after meanwhile.

    Ctrl-C ends the run in order: the station is told and the outcome says INTERRUPTED.

    Raises:
        StationSilentError: the station never came, or fell silent.
        EndpointError: the link itself broke.
    """
    conversation = Conversation(gateway, endpoint, recorder, patience, watch=watch)
    try:
        conversation.wait_for_station()
        while gateway.outcome is None:
            conversation.send(gateway.open_tick())
            if not gateway.immediate:
                gateway.settle()  # while the station thinks
            conversation.catch_up()
            _await_answer(gateway, conversation)
            if gateway.immediate:
                gateway.settle()
            progress(conversation.finish_tick())
    except KeyboardInterrupt:
        gateway.outcome = Outcome(EndReason.INTERRUPTED, gateway.tick)
    conversation.say_goodbye(gateway.outcome)
    return gateway.outcome


def _await_answer(gateway: Gateway, conversation: Conversation) -> None:
    """Send this tick again until it is answered; the station answers a repeat with the same."""
    while not conversation.listen_for(lambda: gateway.answered):
        if gateway.station_end is not None:
            return  # it has ended the run, and will not answer any more
        conversation.check_silence()
        conversation.send(gateway.repeat_tick())
