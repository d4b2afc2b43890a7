"""One side of a run alone: the other one is somebody else's."""

from contextlib import ExitStack, closing
from dataclasses import replace

from laglab.runs.clock import LoopClock
from laglab.runs.ending import Ending
from laglab.runs.errors import CUT_SHORT, SIDE_ERRORS
from laglab.runs.looping import looping
from laglab.runs.robot_side import OpenRobot
from laglab_gateway import Outcome, Surroundings
from laglab_protocol import EndReason, Listener
from laglab_station import Onlooker, Station, run_station


def serve_alone(robot: OpenRobot, around: Surroundings, last: ExitStack) -> Ending:
    """The robot's side to the end, its record closed; what breaks is in the ending. From the end of
    the loop until `last` is closed an interrupt waits."""
    clock = LoopClock(around.progress)
    warnings: list[str] = []

    def warn(text: str) -> None:
        warnings.append(text)
        around.warn(text)

    try:
        with closing(around.recorder), looping(last):
            served = robot.serve(replace(around, progress=clock, warn=warn))
    except SIDE_ERRORS as error:
        so_far = robot.so_far()
        cut = _cut_short(error, clock, warnings)
        return replace(cut, link=so_far.link, timing=so_far.timing)
    return Ending(
        outcome=served.outcome,
        loop_seconds=clock.seconds,
        link=served.link,
        timing=served.timing,
        warnings=tuple(warnings),
    )


def answer_alone(
    station: Station,
    listener: Listener,
    silence_timeout: float,
    onlooker: Onlooker,
    clock: LoopClock,
    last: ExitStack,
) -> Ending:
    """The station's side to the end, the onlooker closed, which tells the clock of every tick; what
    breaks is in the ending. From the end of the loop until `last` is closed an interrupt waits."""
    try:
        with closing(onlooker), looping(last):
            outcome = _answered(station, listener, silence_timeout, onlooker)
    except SIDE_ERRORS as error:
        return replace(_cut_short(error, clock, list(station.warnings)), station=station.report())
    report = station.report()
    return Ending(
        outcome=outcome,
        loop_seconds=clock.seconds,
        station=report,
        warnings=report.warnings,
    )


def _answered(
    station: Station, listener: Listener, silence_timeout: float, onlooker: Onlooker
) -> Outcome:
    """How the run ended, as the station knows."""
    try:
        end = run_station(station, listener, silence_timeout, onlooker)
    except KeyboardInterrupt:
        return Outcome(EndReason.INTERRUPTED, station.tick or 0)
    known = end.reason in set(EndReason)
    return Outcome(EndReason(end.reason) if known else EndReason.FAILED, end.tick)


def _cut_short(error: Exception, clock: LoopClock, warnings: list[str]) -> Ending:
    return Ending(
        problem=str(error),
        begun=clock.seconds > 0 or isinstance(error, CUT_SHORT),
        loop_seconds=clock.seconds,
        warnings=tuple(warnings),
    )
