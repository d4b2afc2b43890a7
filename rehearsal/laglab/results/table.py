"""A run's numbers, for reading."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING

from rich.table import Table

from laglab.results.summary import Errors, Following, Summary
from laglab.tables import plain_table
from laglab_gateway import DirectionReport, FateKind, LinkReport, TimingReport
from laglab_station import StationReport

if TYPE_CHECKING:
    from laglab.results.run import Run

SHOWN = 5
"""Alarms."""


def results_table(run: Run) -> Table:
    """Name and value, a row each."""
    table = plain_table(headed=False)
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    for name, value in summary_rows(run).items():
        table.add_row(name, value)
    return table


def summary_rows(run: Run) -> dict[str, str]:
    """Name → value, as far as there is something to say."""
    summary = run.summary
    seen = " (measured)" if summary.pose == "measured" else ""
    late = " (measured, last second)" if seen else ""
    estimated = summary.compare or {summary.estimator: summary.rms_error}
    final, following = summary.final, summary.following
    return {
        "scenario": f"{summary.scenario} ({', '.join(_circumstances(run))})",
        "estimator": summary.estimator,
        **({} if summary.law in ("polar", "unknown") else {"law": summary.law}),
        "delays n, m": f"{summary.n} and {summary.m} ticks",
        f"pose error at the end{late}": f"ρ {_number(final.rho)} m, "
        f"θ {_number(final.theta_error)} rad",
        **({f"distance to the path{seen}": _distance(following)} if following else {}),
        "speeds at the end": f"v {_number(final.v)} m/s, ω {_number(final.omega)} rad/s",
        **{f"RMS error of {name}{seen}": _errors(errors) for name, errors in estimated.items()},
        **(_link_rows(summary.link) if summary.link else {}),
        **(_timing_row(summary.timing) if summary.timing else {}),
        **(_station_rows(summary.station) if summary.station else {}),
        "speed": _speed(summary),
    }


def _circumstances(run: Run) -> list[str]:
    """Without noise, errors are those of rounding: who wonders at them is to know why."""
    simulated = run.summary.side != "station" and run.summary.pose != "measured"
    silent = ["without noise"] if simulated and not run.scenario.noise else []
    return [f"seed {run.summary.seed}", *silent, run.summary.transport]


def _number(value: float | None) -> str:
    return "?" if value is None else f"{value:.3g}"


def _distance(following: Following) -> str:
    rms, largest = following.rms, following.largest
    return f"RMS {rms:.3g} m, at most {largest:.3g} m, over the second half"


def _errors(errors: Errors | None) -> str:
    if errors is None:
        return "nothing was estimated"
    x, y, theta = map(_rms, (errors.x, errors.y, errors.theta))
    return f"x {x} m, y {y} m, θ {theta} rad"


def _rms(value: float) -> str:
    """Those that are beyond all numbers are told as the largest there is."""
    return "beyond 1e+154" if value == sys.float_info.max else _number(value)


def _link_rows(link: LinkReport) -> dict[str, str]:
    """The delay audit, as far as there is anything to say beyond the configured delays."""
    rows = {"commands": _direction(link.command), "measurements": _direction(link.measurement)}
    if link.refused:
        rows["refused commands"] = ", ".join(f"{n} {why}" for why, n in link.refused.items())
    if link.stops:
        more = f" and {link.stops - len(link.failsafe_stops)} more"
        rows["failsafe stops at ticks"] = ", ".join(map(str, link.failsafe_stops)) + (
            more if link.stops > len(link.failsafe_stops) else ""
        )
    if clocks := link.timesync:
        rows["the station's clock"] = (
            f"{1e3 * clocks.offset_s:.3f} ms ahead, "
            f"round trip p50 {1e3 * clocks.round_trip_p50_s:.2f} ms, "
            f"p99 {1e3 * clocks.round_trip_p99_s:.2f} ms"
        )
    return rows


def _direction(audit: DirectionReport) -> str:
    measured = audit.measured
    if measured is None:
        return "none arrived"
    delay = f"{measured.mean:.1f} ticks late ({measured.min} to {measured.max})"
    return (
        f"{audit.arrived} arrived, {delay}"
        + (f"; {_lost(audit.lost)}" if audit.lost else "")
        + (f"; {audit.reordered} out of order" if audit.reordered else "")
    )


def _lost(by_cause: Mapping[str, int]) -> str:
    """Of frames: a command may have several."""
    several = [f"{count} {cause}" for cause, count in by_cause.items()]
    causes = several if len(several) > 1 else [each for each in by_cause if each != FateKind.LOST]
    told = f"{sum(by_cause.values())} frames lost"
    return f"{told}: {', '.join(causes)}" if causes else told


def _timing_row(timing: TimingReport) -> dict[str, str]:
    p50, p99, worst = (1e3 * each for each in (timing.p50_s, timing.p99_s, timing.max_s))
    return {
        "lateness of ticks": f"p50 {p50:.2f} ms, p99 {p99:.2f} ms, max {worst:.2f} ms; "
        f"{timing.missed_deadlines} deadlines missed"
    }


def _station_rows(station: StationReport) -> dict[str, str]:
    """What the station found out by itself: the delays, and its own speed."""
    n, m = ("?" if each is None else each for each in (station.n_seen, station.m_seen))
    delays = f"n {n}, m {m} ticks"
    rows = {"delays as the station saw them": delays}
    if station.alarms:
        rows["alarms at ticks"] = alarm_ticks(station)
    if station.gated:
        rows["wild measurements"] = f"{station.gated}, not used"
    if station.late:
        rows["late measurements"] = f"{station.late}, not used: too late for play-out"
    for each in station.calibration:
        rows[each.name] = f"{100 * each.value:+.1f} % ± {100 * each.deviation:.1f} %"
    if station.tick_p50_s is not None and station.tick_p99_s is not None:
        p50, p99 = 1e6 * station.tick_p50_s, 1e6 * station.tick_p99_s
        rows["the station's answer to a tick"] = f"p50 {p50:.0f} µs, p99 {p99:.0f} µs"
    return rows


def alarm_ticks(station: StationReport) -> str:
    """The first ones, and how many more."""
    ticks = ", ".join(str(alarm.tick) for alarm in station.alarms[:SHOWN])
    more = station.alarms_raised - SHOWN
    return ticks + (f" and {more} more" if more > 0 else "")


def _speed(summary: Summary) -> str:
    factor = summary.real_time_factor
    return f"{summary.ticks} ticks in {summary.wall_time_s:.2f} s" + (
        f", {factor:.1f} × real time" if factor else ""
    )


def warnings(summary: Summary) -> list[str]:
    """What the reader must not overlook."""
    said = list(summary.warnings)
    if summary.station:
        alarms = summary.station.alarms[:SHOWN]
        said += [f"alarm at tick {alarm.tick}: {alarm.cause}" for alarm in alarms]
    if summary.timing and (missed := summary.timing.missed_deadlines):
        said.append(
            f"{missed} of {summary.ticks + 1} ticks began more than a tick late: this machine "
            "cannot keep up; take a smaller --speed"
        )
    return said
