"""The Python way in: a scenario, a run of it, and what it left."""

import tempfile
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import get_args

from laglab.errors import ResultsError, RunError, ScenarioError
from laglab.extras import DRAWING, STEPPING, require
from laglab.progress import progress_of
from laglab.results.complete import Manner, complete, keep
from laglab.results.place import place, withdrawn_unless_begun
from laglab.results.run import Kept, Run
from laglab.runs.ending import Ending
from laglab.runs.rehearse import Transport, rehearse_inline
from laglab.runs.whole import run_into
from laglab.scenario import Scenario, load
from laglab_control import Controller
from laglab_gateway import ROWS, MemoryRecorder
from laglab_protocol import EndReason
from laglab_station import MakeController


def run(
    scenario: Scenario | str | Path,
    overrides: Mapping[str, object] | None = None,
    transport: Transport = "inline",
    out: str | Path | None = None,
    progress: bool = False,
    *,
    force: bool = False,
    controller: MakeController = Controller,
) -> Run:
    """Rehearse a scenario, given itself, by its shipped name or by its file.

    Args:
        overrides: scenario keys that are to be other than the scenario has them.
        transport: what is between the two sides; `inline` runs both in this process.
        out: the folder for the results, which must not hold another run's; None keeps them in
            memory.
        progress: show it on standard error.
        force: take the folder's other run away.
        controller: what computes the station's answers, where that is in this process.

    Raises:
        ScenarioError: there is no such scenario or transport, or it cannot be.
        MissingExtraError: what it needs is not installed.
        PlaceError: the results cannot go there.
        RunError: the run was cut short; what it left is in `out`.
        KeyboardInterrupt: Ctrl-C; what was recorded is in `out`, and nothing goes on running.
    """
    if transport not in get_args(Transport):
        raise ScenarioError(f"transport: take one of {', '.join(get_args(Transport))}")
    if controller is not Controller and transport != "inline":
        raise ScenarioError(f"controller: {transport} has the station in a process of its own")
    chosen = _chosen(scenario, overrides)
    if chosen.plant.ships or chosen.plant.fmu is not None:
        require(STEPPING)
    if out is None:
        chosen.must_end()  # memory has no room for what does not end
    else:
        require(DRAWING)
    manner = Manner(transport=transport, plant=chosen.plant.called)
    with ExitStack() as stack:
        told = stack.enter_context(progress_of(chosen, progress))
        if transport == "inline" and out is None:
            recorder = MemoryRecorder()
            ending = rehearse_inline(chosen, recorder, told, controller=controller)
            return _whole(ending, keep(chosen, manner, ending, recorder))
        if out is not None:
            directory = place(chosen, Path(out), force)
            stack.enter_context(withdrawn_unless_begun(directory))
        else:
            directory = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="laglab-")))
        ending = run_into(directory, chosen, transport, told, controller=controller)
        done = _completed(chosen, manner, ending, directory, figure=out is not None)
        return _whole(ending, done if out is not None else _in_memory(done))


def _chosen(scenario: Scenario | str | Path, overrides: Mapping[str, object] | None) -> Scenario:
    if isinstance(scenario, Scenario):
        return scenario.overridden(overrides) if overrides else scenario
    return load(str(scenario), overrides)


def _completed(
    scenario: Scenario, manner: Manner, ending: Ending, directory: Path, figure: bool
) -> Run:
    """Raises as `complete`; when the run had a problem already, that."""
    try:
        return complete(scenario, manner, ending, directory, figure)
    except ResultsError as error:
        if ending.problem:
            raise RunError(ending.problem) from error
        raise


def _whole(ending: Ending, done: Run) -> Run:
    if ending.outcome is None or ending.problem:
        raise RunError(ending.problem)
    if ending.outcome.reason is EndReason.INTERRUPTED:
        raise KeyboardInterrupt
    return done


def _in_memory(done: Run) -> Run:
    shadows = {name: done.shadow(name) for name in done.scenario.estimator.compare}
    tables = {name: done.table(name) for name in ROWS}
    kept = Kept(done.trace, tables, shadows)
    return Run(done.scenario, done.summary, None, kept)
