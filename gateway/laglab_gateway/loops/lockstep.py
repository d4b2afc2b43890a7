"""Lock-step: tick k goes on when the station has answered it."""

from laglab_gateway.core import Gateway
from laglab_gateway.loops.conversation import Conversation
from laglab_gateway.loops.surroundings import Served, Surroundings, served


def serve_lockstep(gateway: Gateway, around: Surroundings) -> Served:
    """Run a gateway to its last tick.

    Ctrl-C ends the run in order: the station is told and the outcome says INTERRUPTED.

    Raises:
        StationSilentError: the station never came, or fell silent.
        SettingsError: the station ticks at another pace.
        EndpointError: the link itself broke.
        TraceError: what happened could not be kept.
    """
    conversation = Conversation(gateway, around)
    with conversation.run():
        conversation.wait_for_station()
        while gateway.outcome is None:
            conversation.send(gateway.open_tick())
            if not gateway.immediate:
                gateway.settle()  # while the station thinks
            conversation.catch_up()
            _await_answer(gateway, conversation)
            if gateway.immediate:
                gateway.settle()
            conversation.finish_tick()
    return served(gateway)


def _await_answer(gateway: Gateway, conversation: Conversation) -> None:
    """Send this tick again until it is answered; the station answers a repeat with the same."""
    while not conversation.listen_for(lambda: gateway.answered):
        if gateway.station_end is not None:
            return  # the station has ended the run, and will not answer any more
        conversation.check_silence()
        conversation.send(gateway.repeat_tick())
