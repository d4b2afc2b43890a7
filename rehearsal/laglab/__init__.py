"""A rehearsal rig for robots controlled across a network.

    import laglab

    run = laglab.run("fig6")
    run.summary.converged, run.trace["x"], run.figure()

What needs more than the standard library is loaded when it is first asked for.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from laglab.errors import (
        LaglabError,
        PlaceError,
        ResultsError,
        RunError,
        ScenarioError,
        StudyError,
    )
    from laglab.interface import run
    from laglab.results.run import Run, open_run
    from laglab.results.summary import Summary
    from laglab.scenario import Scenario, load
    from laglab.studies.sweep.loading import load_study
    from laglab.studies.sweep.result import StudyResult, open_study
    from laglab.studies.sweep.study import Study
    from laglab.studies.sweep.sweeping import sweep

    __version__: str

_HOMES = {
    "LaglabError": "errors",
    "PlaceError": "errors",
    "ResultsError": "errors",
    "RunError": "errors",
    "ScenarioError": "errors",
    "StudyError": "errors",
    "run": "interface",
    "Run": "results.run",
    "open_run": "results.run",
    "Summary": "results.summary",
    "Scenario": "scenario",
    "load": "scenario",
    "Study": "studies.sweep.study",
    "StudyResult": "studies.sweep.result",
    "load_study": "studies.sweep.loading",
    "open_study": "studies.sweep.result",
    "sweep": "studies.sweep.sweeping",
}

__all__ = [
    "LaglabError",
    "PlaceError",
    "ResultsError",
    "Run",
    "RunError",
    "Scenario",
    "ScenarioError",
    "Study",
    "StudyError",
    "StudyResult",
    "Summary",
    "__version__",
    "load",
    "load_study",
    "open_run",
    "open_study",
    "run",
    "sweep",
]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from laglab.version import laglab_version

        return laglab_version()
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
