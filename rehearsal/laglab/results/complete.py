"""From a record and an ending to a run: what every way of making one has in common."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from laglab.errors import RefusedError, RunError, UndrawableError
from laglab.results.columns import Columns, columns_of
from laglab.results.digest import Digest, digest, followed
from laglab.results.figures import save_figure
from laglab.results.numbers import goal_errors, has_converged, off_in_the_end
from laglab.results.place import withdraw
from laglab.results.run import Kept, Run
from laglab.results.shadows import (
    Shadow,
    collected,
    kept_rows,
    shadow_error,
    shadow_file,
    shadow_rows,
    until_it_fails,
)
from laglab.results.station import decoded
from laglab.results.summary import Errors, Final, Following, Side, Summary, write_summary
from laglab.runs.ending import Ending
from laglab.scenario import Scenario
from laglab.version import laglab_version, versions
from laglab_gateway import (
    ARRIVALS_FILE,
    CLAIMS_FILE,
    LINK_FILE,
    ROWS,
    TIMING_FILE,
    TLOG_FILE,
    TRACE_FILE,
    MemoryRecorder,
    Row,
    Trace,
    TraceError,
    trace_of,
    trace_pieces,
)
from laglab_protocol import EndReason
from laglab_station import StationReport, heard, read_session

CONVERGED = "converged", "did not converge"
AT_ONCE = {
    EndReason.FAILED: "the other side failed before the first tick was over",
    EndReason.DISPLACED: "another station has the robot: end that one first",
}
"""What ended a run of which there is no tick."""
THE_STATIONS = "the station's filter"
"""A gateway alone does not know by which its station estimates."""


class Manner(NamedTuple):
    """How a run was made."""

    side: Side = "both"
    transport: str = "inline"
    plant: str = "robot"


def complete(
    scenario: Scenario, manner: Manner, ending: Ending, directory: Path, figure: bool = True
) -> Run:
    """Put summary, shadows and figure beside the record in `directory`.

    Raises:
        RunError: there is no record, for the run ended before its first tick.
        ResultsError: something cannot be written.
    """
    try:
        numbers = digest(trace_pieces(directory / TRACE_FILE), scenario.link.m)
    except TraceError as error:
        why = nothing_recorded(ending, str(error))
        if isinstance(why, RefusedError):
            withdraw(directory)
        raise why from None
    failed: list[str] = []
    compared = {
        name: _shadowed(scenario, name, directory, failed) for name in scenario.estimator.compare
    }
    ending = ending.warned(failed)
    following = followed(trace_pieces(directory / TRACE_FILE), scenario.target, numbers.rows)
    summary = summarise(scenario, manner, ending, numbers, compared, following)
    write_summary(summary, directory)
    run = Run(scenario, summary, directory)
    return _pictured(run, directory) if figure else run


def _pictured(run: Run, directory: Path) -> Run:
    """With its figure; where that cannot be drawn, the run is what it is all the same."""
    try:
        save_figure(run.figure, directory)
    except UndrawableError as error:
        told = (*run.summary.warnings, str(error))
        run = replace(run, summary=msgspec.structs.replace(run.summary, warnings=told))
        write_summary(run.summary, directory)
    return run


def keep(scenario: Scenario, manner: Manner, ending: Ending, recorder: MemoryRecorder) -> Run:
    """The same in memory. Raises RunError when there is no record."""
    if not recorder.rows:
        raise nothing_recorded(ending, "the run ended before its first tick was over")
    trace = trace_of(recorder.rows)
    names = scenario.estimator.compare
    session = list(heard(decoded(raw for _, raw in recorder.tlog))) if names else []
    shadows: dict[str, Shadow] = {}
    compared: dict[str, Errors | None] = {}
    failed: list[str] = []
    for name in names:
        rows = list(until_it_fails(shadow_rows(scenario, name, session), failed.append))
        shadows[name] = collected(rows)
        compared[name] = shadow_error(rows, [trace], scenario.link.m)
    numbers = digest([trace], scenario.link.m)
    following = followed([trace], scenario.target, numbers.rows)
    ending = ending.warned(failed)
    summary = summarise(scenario, manner, ending, numbers, compared, following)
    return Run(scenario, summary, None, Kept(trace, _tables(recorder), shadows))


def _tables(recorder: MemoryRecorder) -> dict[str, Columns]:
    rows: dict[str, Sequence[Row]] = {
        LINK_FILE: recorder.link_rows,
        ARRIVALS_FILE: recorder.arrival_rows,
        CLAIMS_FILE: recorder.claim_rows,
        TIMING_FILE: recorder.timing_rows,
    }
    return {name: columns_of(rows[name], kind) for name, kind in ROWS.items()}


def nothing_recorded(ending: Ending, otherwise: str) -> BaseException:
    """What to raise for a run of which there is nothing to show."""
    if ending.outcome and ending.outcome.reason is EndReason.INTERRUPTED:
        return KeyboardInterrupt()
    if not ending.begun:
        return RefusedError(ending.problem)
    told = AT_ONCE.get(ending.outcome.reason) if ending.outcome else None
    return RunError(ending.problem or told or otherwise)


def _shadowed(scenario: Scenario, name: str, directory: Path, failed: list[str]) -> Errors | None:
    tlog = (directory / TLOG_FILE).absolute()  # opened when the filter is under way
    session = read_session(tlog)
    rows = until_it_fails(shadow_rows(scenario, name, session), failed.append)
    written = kept_rows(rows, shadow_file(directory, name))
    pieces = trace_pieces(directory / TRACE_FILE)
    return shadow_error(written, pieces, scenario.link.m)


def summarise(
    scenario: Scenario,
    manner: Manner,
    ending: Ending,
    numbers: Digest,
    compared: dict[str, Errors | None],
    following: Following | None = None,
) -> Summary:
    """The run in numbers."""
    end, outcome = numbers.end, ending.outcome
    ticks = round(float(end["time"][-1]) / scenario.sample_time)
    completed = outcome is not None and outcome.reason is EndReason.COMPLETED
    wanted = scenario.target.poses(end["tick"])
    converged = completed and has_converged(end, wanted)
    final = _final(end, wanted)
    seconds = ending.loop_seconds
    estimator = THE_STATIONS if manner.side == "robot" else scenario.estimator.kind
    in_loop = {estimator: numbers.rms_error} if compared else {}
    return Summary(
        laglab=laglab_version(),
        versions=versions(),
        scenario=scenario.name,
        side=manner.side,
        transport=manner.transport,
        plant=manner.plant,
        estimator=estimator,
        law="unknown" if manner.side == "robot" else scenario.law.kind,
        n=scenario.link.n,
        m=scenario.link.m,
        seed=scenario.seed,
        ticks=ticks,
        pose=numbers.seen,
        final=final,
        rms_error=numbers.rms_error,
        compare=in_loop | compared,
        outcome=outcome.reason.name.lower() if outcome else None,
        converged=converged,
        following=following,
        wall_time_s=seconds,
        real_time_factor=ticks * scenario.sample_time / seconds if seconds else None,
        link=ending.link,
        timing=ending.timing,
        station=ending.station,
        warnings=ending.warnings,
        verdict=_verdict(ending, final, converged, ticks, numbers.seen == "measured", following),
    )


def _after_alarms(station: StationReport | None) -> str:
    if station is None or not station.alarms:
        return ""
    times = "an alarm" if station.alarms_raised == 1 else f"{station.alarms_raised} alarms"
    return f" after {times}, the first at tick {station.alarms[0].tick}"


def _final(end: Trace, wanted: NDArray[np.float64]) -> Final:
    """At the last tick; of what is told later or not at all, the last that is known. A pose that is
    measured is that of the last second, by which it is judged."""
    rho, theta_error = goal_errors(off_in_the_end(end, wanted), (0.0, 0.0, 0.0))
    numbers = _last(rho), _last(theta_error), _last(end["v"]), _last(end["omega"])
    return Final(*(float(number) if abs(number) < float("inf") else None for number in numbers))


def _last(column: NDArray[np.float64]) -> float:
    there = column[~np.isnan(column)]
    return float(there[-1]) if len(there) else np.nan


def _verdict(
    ending: Ending,
    final: Final,
    converged: bool,
    ticks: int,
    measured: bool,
    following: Following | None,
) -> str:
    if ending.outcome is None:
        return f"cut short at tick {ticks}: {ending.problem}"
    tick = ending.outcome.tick
    match ending.outcome.reason:
        case EndReason.DIVERGED:
            return f"stopped at tick {tick}: the estimate diverged (not finite, or beyond 1 km)"
        case EndReason.INTERRUPTED:
            return f"interrupted at tick {tick}"
        case EndReason.FAILED:
            said = ending.problem.removeprefix(f"tick {tick}: ") or "the other side failed"
            return f"stopped at tick {tick}: {said}"
        case EndReason.DISPLACED:
            return f"stopped at tick {tick}: another station has taken over"
    stopped = "after an emergency stop: " if ending.emergency_stop else ""
    reached = ("follows its path", "does not follow its path") if following else CONVERGED
    word = stopped + reached[not converged] + _after_alarms(ending.station)
    seen = " as measured" if measured else ""
    if following:
        return (
            f"{word}: {following.rms:.3g} m from it (RMS), {following.largest:.3g} m at most, over "
            f"the second half{seen}"
        )
    if final.rho is None or final.theta_error is None:
        return f"{word}: where the robot is at the end is not known"
    seen = " as measured over the last second" if measured else ""
    return f"{word}: at the end ρ = {final.rho:.3g} m, θ error = {final.theta_error:.3g} rad{seen}"
