"""A rehearsal rig for robots controlled across a network.

    import laglab

    run = laglab.run("fig6")
    run.summary.converged, run.trace["x"], run.figure()

What needs more than the standard library is loaded when it is first asked for.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from laglab.errors import LaglabError, PlaceError, ResultsError, RunError, ScenarioError
    from laglab.interface import run
    from laglab.results.run import Run, open_run
    from laglab.results.summary import Summary
    from laglab.scenario import Scenario, load

    __version__: str

_HOMES = {
    "LaglabError": "errors",
    "PlaceError": "errors",
    "ResultsError": "errors",
    "RunError": "errors",
    "ScenarioError": "errors",
    "run": "interface",
    "Run": "results.run",
    "open_run": "results.run",
    "Summary": "results.summary",
    "Scenario": "scenario",
    "load": "scenario",
}

__all__ = [
    "LaglabError",
    "PlaceError",
    "ResultsError",
    "Run",
    "RunError",
    "Scenario",
    "ScenarioError",
    "Summary",
    "__version__",
    "load",
    "open_run",
    "run",
]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from laglab.version import laglab_version

        return laglab_version()
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
