"""An estimator beside a session that is over."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from laglab_control import Control, Controller, Demand, StationConfig, at_tick
from laglab_control.model import Matrix, Vector
from laglab_station.hearing import echoes, measured, recalled
from laglab_station.session import SessionTick

NOTHING = np.full((3, 3), np.nan)


class ShadowRow(NamedTuple):
    """What the estimator says at a tick heard; NaN where it says nothing."""

    tick: int
    """As recorded."""
    x: Vector
    """(3,) [m, m, rad]."""
    P: Matrix
    """(3, 3)."""


def shadow(config: StationConfig, session: Iterable[SessionTick]) -> Iterator[ShadowRow]:
    """Run `config.estimator` beside the commands that were sent; the first tick heard is tick 0.

    Raises PluginFailedError, naming the tick, when an estimator that somebody brought fails.
    The law of `config` is not asked. Over ticks that are missing, the last command held. It ends
    early when the estimate has become infinite.
    """
    controller = Controller(config)
    control = controller.start()
    first = last = None
    for heard in session:
        first, last = (heard.tick, heard.tick) if first is None or last is None else (first, last)
        with at_tick(heard.tick):
            for _ in range(heard.tick - last):
                control = controller.advance(control)
            control = _followed(controller, control, heard, first)
        last = heard.tick
        x, P = control.pose, control.P
        if x is not None and not np.all(np.isfinite(x)):
            return
        yield ShadowRow(last, NOTHING[0] if x is None else x, NOTHING if P is None else P)


def _followed(controller: Controller, control: Control, heard: SessionTick, first: int) -> Control:
    """The controller's correction, with the command that was really sent, or the last one."""
    drive = control.drive
    if heard.command is not None:
        drive = Demand(heard.command.v, heard.command.omega)
    with np.errstate(over="ignore", invalid="ignore"):
        control = controller.correct(
            control,
            measured(heard.measurements, first, heard.tick),
            echoes(heard.measurements, first, heard.tick),
            recalled(heard.recalled, first, heard.tick),
        )
    return control._replace(drive=drive)
