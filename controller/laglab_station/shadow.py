"""An estimator beside a session that is over."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from laglab_control import Control, Controller, Demand, Matrix, StationConfig, Vector, at_tick
from laglab_station.hearing import Came, PlayedOut, echoes, measured, recalled
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


def shadow(
    config: StationConfig, session: Iterable[SessionTick], playout: int = 0
) -> Iterator[ShadowRow]:
    """Run `config.estimator` beside the commands that were sent; the first tick heard is tick 0.

    Measurements are played out as by the station. Raises PluginFailedError, naming the tick, when
    an estimator that somebody brought fails. The law of `config` is not asked. Over ticks that are
    missing, the last command held, or its plan went on. It ends early when the estimate has become
    infinite, or the robot has begun again: it may be anywhere.
    """
    controller = Controller(config)
    control = controller.start()
    first = last = None
    for heard in _played_out(session, playout):
        first, last = (heard.tick, heard.tick) if first is None or last is None else (first, last)
        if heard.tick < last:
            return
        with at_tick(heard.tick), np.errstate(over="ignore", invalid="ignore"):
            for lost in range(heard.tick - last):
                control = controller.unanswered(control) if lost else control
                control = controller.advance(control)
            control = _followed(controller, control, heard, first)
        last = heard.tick
        x, P = control.pose, control.P
        if x is not None and not np.all(np.isfinite(x)):
            return
        yield ShadowRow(last, NOTHING[0] if x is None else x, NOTHING if P is None else P)


def _played_out(session: Iterable[SessionTick], bound: int) -> Iterable[SessionTick]:
    if not bound:
        return session
    held = PlayedOut(bound)
    return (
        heard._replace(
            measurements=held.take(heard.tick, Came(heard.measurements, ())).measurements
        )
        for heard in session
    )


def _followed(controller: Controller, control: Control, heard: SessionTick, first: int) -> Control:
    """The controller's correction, with the command that was really sent, or the last one."""
    if heard.command is None:
        control = controller.unanswered(control)
        drive, plan = control.drive, control.plan
    else:
        drive = Demand(heard.command.v, heard.command.omega)
        plan = tuple(Demand(v, omega) for v, omega in heard.following)
    control = controller.correct(
        control,
        measured(heard.measurements, first, heard.tick),
        echoes(heard.measurements, first, heard.tick),
        recalled(heard.recalled, first, heard.tick),
    )
    return control._replace(drive=drive, plan=plan)
