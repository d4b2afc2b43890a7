"""The robot's end of the way of commands, by itself."""

import pytest

from laglab_gateway import Channel
from laglab_gateway.incoming import Incoming
from laglab_protocol import Command, Planned


def planned(tick: int, length: int, in_force: int) -> Planned:
    command = Command(0.1, 0.0, tick, 1, 1, 0, length)
    return Planned(command, in_force, ((0.2, 0.0),) * length)


def ready(way: Incoming, tick: int) -> list[int]:
    return [each.tick for each in way.take(tick).ready]


@pytest.mark.parametrize("playout", [0, 5])
def test_what_is_cleared_comes_no_more(playout: int) -> None:
    """Be it on the link, held for play-out or for its tick, or waiting for the rest of its plan."""
    way = Incoming(Channel("command", 0, 0.01), playout)
    early, part = planned(0, 3, in_force=4), planned(1, 30, in_force=1)
    for plan in (early, part):
        way.push(0, plan.command, plan.frames()[:1])
    assert ready(way, 0) == []
    way.clear()
    way.push(1, Command(0.1, 0.0, 1, 1, 1, 0), part.frames()[1:])
    assert [tick for k in range(1, 12) for tick in ready(way, k)] == [1]
