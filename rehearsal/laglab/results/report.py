"""What a run leaves for its reader: a table, the verdict, a figure and a summary."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.table import Table

from laglab.results.figure import FIGURE_FILE, draw_deviations, draw_run, save
from laglab.results.replaying import replay_session
from laglab.results.summary import deviation, loop_estimates, rms_error, summarise, write_summary
from laglab.run.rehearse import Ending, Transport
from laglab.scenario import Scenario
from laglab_gateway import TLOG_FILE, Trace
from laglab_station import read_session


def write_results(
    scenario: Scenario, transport: Transport, ending: Ending, trace: Trace, directory: Path
) -> dict[str, Any]:
    """Write ``summary.json`` and ``figure.png``; returns the summary."""
    summary = summarise(scenario, transport, ending, trace)
    if scenario.estimator.compare:
        deviations = compare(scenario, trace, directory / TLOG_FILE)
        summary["compare"] = {
            name: rms_error(values, scenario.link.measurement_delay)
            for name, values in deviations.items()
        }
        figure = draw_deviations(trace["time"], deviations, scenario)
    else:
        figure = draw_run(trace, scenario)
    write_summary(summary, directory)
    save(figure, directory / FIGURE_FILE)
    return summary


def compare(scenario: Scenario, trace: Trace, tlog: Path) -> dict[str, NDArray[np.float64]]:
    """Deviations of the estimator in the loop, and of each in ``compare``, which shadows it on the
    session that was recorded."""
    session = list(read_session(tlog))
    estimates = {scenario.estimator.kind: loop_estimates(trace)}
    for name in scenario.estimator.compare:
        estimates[name] = np.full_like(estimates[scenario.estimator.kind], np.nan)
        replayed = replay_session(scenario, name, session)
        estimates[name][np.searchsorted(trace["tick"], replayed.ticks)] = replayed.estimates
    return {name: deviation(trace, values) for name, values in estimates.items()}


def results_table(summary: dict[str, Any]) -> Table:
    """The summary's numbers, for reading."""
    table = Table(box=None, show_header=False)
    delays = f"{summary['n']} and {summary['m']} ticks"
    final = summary["final"]
    estimated = summary.get("compare", {summary["estimator"]: summary["rms_error"]})
    factor = summary["real_time_factor"]
    seen = " (measured)" if summary["pose"] == "measured" else ""
    rows = {
        "scenario": f"{summary['scenario']} (seed {summary['seed']}, {summary['transport']})",
        "estimator": summary["estimator"],
        "delays n, m": delays,
        f"pose error at the end{seen}": f"ρ {final['rho']:.3g} m, θ {final['theta_error']:.3g} rad",
        "speeds at the end": f"v {final['v']:.3g} m/s, ω {final['omega']:.3g} rad/s",
        **{f"RMS error of {name}{seen}": _errors(errors) for name, errors in estimated.items()},
        **_link_rows(summary.get("link", {})),
        **_timing_row(summary.get("timing")),
        **_station_rows(summary.get("station", {})),
        "speed": f"{summary['ticks']} ticks in {summary['wall_time_s']:.2f} s"
        + (f", {factor:.1f} × real time" if factor else ""),
    }
    for name, value in rows.items():
        table.add_row(name, value)
    return table


def _link_rows(audit: dict[str, Any]) -> dict[str, str]:
    """The delay audit, as far as there is anything to say beyond the configured delays."""
    rows = {f"{name}s": _direction(audit[name]) for name in ("command", "measurement") if audit}
    refused = ", ".join(f"{count} {why}" for why, count in audit.get("refused", {}).items())
    stops = ", ".join(str(tick) for tick in audit.get("failsafe_stops", []))
    if refused:
        rows["refused commands"] = refused
    if stops:
        rows["failsafe stops at ticks"] = stops
    if clocks := audit.get("timesync"):
        rows["the station's clock"] = (
            f"{1e3 * clocks['offset_s']:.3f} ms ahead, "
            f"round trip p50 {1e3 * clocks['round_trip_p50_s']:.2f} ms, "
            f"p99 {1e3 * clocks['round_trip_p99_s']:.2f} ms"
        )
    return rows


def _direction(audit: dict[str, Any]) -> str:
    measured, lost = audit["measured"], sum(audit["lost"].values())
    if measured is None:
        return "none arrived"
    delay = f"{measured['mean']:.1f} ticks late ({measured['min']} to {measured['max']})"
    causes = ", ".join(f"{count} {cause}" for cause, count in audit["lost"].items())
    return (
        f"{audit['arrived']} arrived, {delay}"
        + (f"; lost {lost}: {causes}" if lost else "")
        + (f"; {audit['reordered']} out of order" if audit["reordered"] else "")
    )


def _timing_row(timing: dict[str, Any] | None) -> dict[str, str]:
    if timing is None:
        return {}
    p50, p99, worst = (1e3 * timing[key] for key in ("p50_s", "p99_s", "max_s"))
    return {
        "lateness of ticks": f"p50 {p50:.2f} ms, p99 {p99:.2f} ms, max {worst:.2f} ms; "
        f"{timing['missed_deadlines']} deadlines missed"
    }


def _station_rows(station: dict[str, Any]) -> dict[str, str]:
    """What the station found out by itself: the delays, and its own speed."""
    if not station:
        return {}
    rows = {"delays as the station saw them": f"n {station['n_seen']}, m {station['m_seen']} ticks"}
    if "tick_p99_s" in station:
        p50, p99 = (1e6 * station[f"tick_{name}_s"] for name in ("p50", "p99"))
        rows["the station's answer to a tick"] = f"p50 {p50:.0f} µs, p99 {p99:.0f} µs"
    return rows


def warnings(summary: dict[str, Any]) -> list[str]:
    """What the reader must not overlook."""
    said = list(summary.get("station", {}).get("warnings", []))
    if missed := summary.get("timing", {}).get("missed_deadlines", 0):
        said.append(
            f"{missed} of {summary['ticks']} ticks began more than a tick late: this machine "
            "cannot keep up; take a smaller --speed"
        )
    return said


def _errors(errors: dict[str, float] | None) -> str:
    if errors is None:
        return "nothing was estimated"
    return f"x {errors['x']:.3g} m, y {errors['y']:.3g} m, θ {errors['theta']:.3g} rad"
