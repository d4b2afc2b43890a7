"""A side that finds late that the other one ticks at another pace."""

import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import replace

import pytest

from laglab.runs.alone import serve_alone
from laglab.runs.robot_side import Setup, open_robot
from laglab.scenario import load
from laglab_gateway import Served, Surroundings
from laglab_protocol import Listener, Receiver, SettingsError, open_endpoint


def ending_after(ticks: int) -> Callable[[Surroundings], Served]:
    """As when a real robot was switched off, and another one on."""

    def serve(around: Surroundings) -> Served:
        for tick in range(ticks):
            around.progress(tick)
            time.sleep(0.001)
        raise SettingsError("the sample time is 0.02 s for the robot and 0.01 s for this gateway")

    return serve


@pytest.mark.parametrize(("ticks", "code"), [(0, 2), (3, 4)])
def test_a_run_that_had_begun_was_cut_short(ticks: int, code: int) -> None:
    """Exit code 2 says that nothing has run."""
    with (
        open_robot(load("lab"), Setup()) as robot,
        open_endpoint("udpin://127.0.0.1:0") as link,
        ExitStack() as last,
    ):
        around = Surroundings(Listener(link, Receiver()))
        ending = serve_alone(replace(robot, serve=ending_after(ticks)), around, last)
    assert (ending.begun, ending.exit_code) == (ticks > 0, code)
