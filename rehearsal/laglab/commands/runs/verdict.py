"""What a command says of a run that is over."""

import sys
from importlib.util import find_spec
from pathlib import Path

from laglab.errors import RefusedError, ResultsError, RunError
from laglab.live import LivePage
from laglab.results.complete import Manner, complete
from laglab.results.place import REPORT_FILE
from laglab.results.run import Run
from laglab.results.table import results_table, warnings
from laglab.runs.ending import Ending
from laglab.scenario import Scenario
from laglab.tables import say, terminal

LONG = 20_000
"""[ticks] With fewer an estimator beside the loop takes seconds."""


def conclude(
    scenario: Scenario,
    manner: Manner,
    ending: Ending,
    directory: Path,
    report: bool = False,
    page: LivePage | None = None,
) -> int:
    """Say at once what broke, if something did; write the results and show them; the exit code.
    Raises ResultsError, and KeyboardInterrupt for a run that never began."""
    if ending.problem:
        print(f"laglab: {ending.problem}", file=sys.stderr, flush=True)
        _tell(page, ending.problem)
    _say_what_takes_long(scenario, ending)
    try:
        run = complete(scenario, manner, ending, directory)
        _tell(page, run.summary.verdict)
        _show(run)
        if report:
            report_on(run)
    except (RefusedError, RunError):
        if not ending.problem:
            raise
    except ResultsError as error:
        if not ending.problem:
            raise
        say(f"warning: {error}")
    return ending.exit_code


def _say_what_takes_long(scenario: Scenario, ending: Ending) -> None:
    names = scenario.estimator.compare
    if names and ending.outcome and ending.outcome.tick > LONG:
        say(f"what {' and '.join(names)} would have said, of {ending.outcome.tick} ticks ...")


def _tell(page: LivePage | None, verdict: str) -> None:
    if page is not None:
        page.over(verdict)


def report_on(run: Run) -> None:
    """Leave a report beside the run's other files. Needs bokeh."""
    from laglab.results.report import save_report

    if run.directory:
        place = run.directory / REPORT_FILE
        save_report([run], place)
        print(f"report in {place}")


def _show(run: Run) -> None:
    """Table, warnings, verdict and place."""
    terminal().print(results_table(run))
    for warning in warnings(run.summary):
        say(f"warning: {warning}")
    print(run.summary.verdict)
    print(f"results in {run.directory}")
    if find_spec("matplotlib") is None:
        say("no figure: matplotlib is not installed here")
