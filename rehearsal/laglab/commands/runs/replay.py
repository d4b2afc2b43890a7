"""``laglab replay``."""

from pathlib import Path
from typing import Annotated

import typer

from laglab.commands.options import WidthOption
from laglab.errors import ScenarioError
from laglab.extras import DRAWING, SEEING, require
from laglab.results.figures import save
from laglab.results.place import REPORT_FILE, replay_place
from laglab.results.replaying import draw_replays, replayed_run, replays_table
from laglab.results.run import Run, kept_scenario, open_run
from laglab.results.shadows import collected, file_name, kept_rows, shadow_rows
from laglab.scenario import load
from laglab.scenario.tables.estimator import COMPARABLE
from laglab.tables import terminal
from laglab_gateway import TLOG_FILE, TRACE_FILE, read_trace
from laglab_station import read_session

TlogArgument = Annotated[
    Path,
    typer.Argument(
        metavar="TLOG",
        help="A session's telemetry log, robot.tlog, or a run's folder.",
        exists=True,
    ),
]


def replay(
    tlog: TlogArgument,
    estimators: Annotated[
        list[str],
        typer.Option(
            "--estimator",
            metavar="NAME",
            help=f"A filter; may be repeated: {', '.join(COMPARABLE)}.",
            autocompletion=lambda: COMPARABLE,
        ),
    ],
    scenario: Annotated[
        str | None,
        typer.Option(
            metavar="SCENARIO",
            help="The model and the prior; the scenario.toml beside the log otherwise.",
        ),
    ] = None,
    p0: Annotated[float | None, typer.Option("--p0", help="P_0 = VALUE·I.")] = None,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Where results go.")] = Path(
        "replay"
    ),
    width: WidthOption = "two",
    report: Annotated[
        bool, typer.Option("--report", help="Leave report.html, too, of the run with these.")
    ] = False,
) -> None:
    """Estimate again from the log of a run, simulated or real."""
    require(DRAWING)
    if report:
        require(SEEING)
    tlog = tlog / TLOG_FILE if tlog.is_dir() else tlog
    overrides = {} if p0 is None else {"estimator.initial_covariance": p0}
    told = load(scenario, overrides) if scenario else kept_scenario(tlog.parent, overrides)
    session = list(read_session(tlog))
    if not session:
        raise ScenarioError(f"{tlog}: no tick of a robot in it")
    trace_file = tlog.parent / TRACE_FILE
    trace = read_trace(trace_file) if trace_file.exists() else None
    if report:
        open_run(tlog.parent)  # before anything is computed
    asked = {name: shadow_rows(told, name, session) for name in estimators}
    directory = replay_place(out, tlog)
    replays = {
        name: collected(kept_rows(rows, directory / f"{file_name(name)}.csv"))
        for name, rows in asked.items()
    }
    terminal().print(replays_table(replays, trace))
    save(draw_replays(told, session, replays, trace, width), directory / "replay.png")
    if report:
        _report(replayed_run(tlog.parent, replays), directory)
    print(f"results in {out}")


def _report(run: Run, directory: Path) -> None:
    from laglab.results.report import save_report

    save_report([run], directory / REPORT_FILE)
