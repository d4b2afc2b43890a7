"""An estimator over a recorded session: what it would have said in the station's place."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from laglab_control.controller import Control, Controller, StationConfig
from laglab_control.laws.aicardi import Drive
from laglab_control.model import Matrix, Vector
from laglab_station.hearing import echoes, measured
from laglab_station.session import Heard


class Shadow(NamedTuple):
    """What the estimator says at the ticks heard; NaN where it says nothing."""

    ticks: Vector
    """(N,), as recorded; fewer than were heard when the estimate has become infinite."""
    estimates: Vector
    """(N, 3) [m, m, rad]."""
    covariances: Matrix
    """(N, 3, 3)."""


def shadow(config: StationConfig, session: Iterable[Heard]) -> Shadow:
    """Run `config.estimator` beside the commands that were sent; the first tick heard is tick 0.

    The law of `config` is not asked. Over ticks that are missing, the last command held.
    """
    controller = Controller(config)
    control = controller.start()
    answer: list[tuple[int, Vector, Matrix]] = []
    first = last = None
    for heard in session:
        first, last = (heard.tick, heard.tick) if first is None or last is None else (first, last)
        for _ in range(heard.tick - last):
            control = controller.advance(control)
        last = heard.tick
        control = _followed(controller, control, heard, first)
        x, P = control.estimate.x, control.estimate.P
        if x is not None and not np.all(np.isfinite(x)):
            break
        nothing = np.full((3, 3), np.nan)
        answer.append((last, nothing[0] if x is None else x, nothing if P is None else P))
    ticks, estimates, covariances = zip(*answer, strict=True) if answer else ((), (), ())
    return Shadow(
        np.array(ticks, dtype=np.float64),
        np.array(estimates, dtype=np.float64).reshape(-1, 3),
        np.array(covariances, dtype=np.float64).reshape(-1, 3, 3),
    )


def _followed(controller: Controller, control: Control, heard: Heard, first: int) -> Control:
    """The controller's answer, but with the command that was really sent, or the last one."""
    drive = control.drive
    if heard.command is not None:
        drive = Drive(heard.command.v, heard.command.omega, at_goal=False)
    with np.errstate(over="ignore", invalid="ignore"):
        control = controller.answer(
            control,
            measured(heard.measurements, first, heard.tick),
            echoes(heard.measurements, first, heard.tick),
        )
    return control._replace(drive=drive)
