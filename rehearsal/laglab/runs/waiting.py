"""What somebody's code may never come back from."""

from collections.abc import Callable
from threading import Thread

from laglab_control import PluginError

START = 30.0
"""[s] How long a side, or what somebody brought, may take to begin."""


def in_time(name: str, work: Callable[[], object], seconds: float = START) -> None:
    """Does the work. Raises what it raises, or PluginError: it still goes on after `seconds`.

    It is done in a thread, which nobody can stop: whoever hears of it ends the process.
    """
    raised: list[BaseException] = []

    def done() -> None:
        try:
            work()
        except BaseException as error:
            raised.append(error)

    thread = Thread(target=done, daemon=True)
    thread.start()
    thread.join(seconds)
    if thread.is_alive():
        raise PluginError(f"{name} does not come back: {seconds:g} s were not enough to make it")
    if raised:
        raise raised[0]
