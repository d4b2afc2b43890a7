"""From the end of a run's loop an interrupt waits for its results."""

import signal
from contextlib import ExitStack
from pathlib import Path
from typing import get_args

import pytest

from laglab.results.place import place
from laglab.runs.rehearse import Transport, unheard
from laglab.runs.robot_side import Setup
from laglab.runs.whole import run_into
from laglab.scenario import load


@pytest.mark.parametrize("transport", get_args(Transport))
def test_an_interrupt_waits_from_the_loops_end(tmp_path: Path, transport: Transport) -> None:
    scenario = load("fig6", {"duration": 0.2})
    directory = place(scenario, tmp_path / "run")
    last = ExitStack()
    ending = run_into(directory, scenario, transport, unheard, Setup(last=last))
    signal.raise_signal(signal.SIGINT)
    assert ending.outcome is not None
    assert ending.outcome.tick == 20
    with pytest.raises(KeyboardInterrupt):
        last.close()


def test_without_anything_to_wait_for_it_does_not(tmp_path: Path) -> None:
    scenario = load("fig6", {"duration": 0.2})
    ending = run_into(place(scenario, tmp_path / "run"), scenario, "inline", unheard)
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)
    assert ending.outcome
