"""The conformance kit: does whatever answers at this address speak our protocol?"""

from collections.abc import Callable
from pathlib import Path
from typing import Literal

from laglab_conformance import controller, freerunning, lockstep
from laglab_conformance.items import Item, carry_out
from laglab_conformance.report import Mark, Report, Result
from laglab_conformance.session import Waits
from laglab_protocol import open_endpoint

__all__ = ["Mark", "Pace", "Report", "Result", "Scope", "Side", "Waits", "conform"]

Side = Literal["robot", "controller"]
Pace = Literal["lockstep", "realtime"]
Scope = Literal["all", "silence", "reading"]
SCOPES: dict[Scope, list[Item[lockstep.LockstepSession]]] = {
    "all": lockstep.ITEMS,
    "silence": lockstep.GIVING_UP,
    "reading": lockstep.READING,
}


def conform(
    url: str,
    side: Side,
    key_file: Path | None = None,
    waits: Waits | None = None,
    pace: Pace = "lockstep",
    scope: Scope = "all",
    progress: Callable[[str], None] = lambda _: None,
) -> Report:
    """Test the robot, or the controller, that answers at `url`; its run is over afterwards.

    A robot is never told to go faster than 1e-6 m/s; `pace` says whether it waits for each command
    or has a clock of its own; `scope`, of one in lock-step, whether all is tried, or only whether
    it gives up a silent station, or only how it reads frames; `progress` is told where it is, and
    then what is tried.
    After Ctrl-C the report has the items that were tried by then (`Report.is_whole`).
    Raises the EndpointError and KeyFileError trees.
    """
    with open_endpoint(url) as endpoint:
        progress(f"testing the {side} at {endpoint.name}")
        talk = endpoint, waits or Waits(), key_file
        if side == "controller":
            results = carry_out(controller.ITEMS, controller.ControllerSession(*talk), progress)
        elif pace == "lockstep":
            results = carry_out(SCOPES[scope], lockstep.LockstepSession(*talk), progress)
        else:
            results = carry_out(freerunning.ITEMS, freerunning.FreeRunningSession(*talk), progress)
    return Report(side, results)
