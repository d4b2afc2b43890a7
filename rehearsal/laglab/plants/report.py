"""What a look at a robot found, as tables and as TOML."""

from collections.abc import Mapping

import tomlkit
from rich.table import Table

from laglab.plants.proposal import Proposal, candidates
from laglab.plants.trial import OMEGA, PHASE, Trial, V
from laglab.scenario import Scenario
from laglab.tables import plain_table
from laglab_fmu.foreign import FmuFile

MOST = 60
"""Numbers that are listed; an FMU may have thousands."""
CAUSALITIES = ("input", "output", "parameter")


def offered(file: FmuFile, proposal: Proposal) -> Table:
    """What could be mapped, and what is proposed."""
    roles = proposal.roles()
    there = [each for each in candidates(file) if each.causality in CAUSALITIES]
    there.sort(key=lambda each: (each.name not in roles, CAUSALITIES.index(each.causality)))
    table = plain_table("variable", "is", "proposed for")
    for each in there[:MOST]:
        table.add_row(each.name, each.causality, roles.get(each.name, ""))
    if len(there) > MOST:
        table.add_row(f"... {len(there) - MOST} more", "", "")
    return table


def headed(file: FmuFile) -> str:
    """What kind of FMU it is."""
    needs = "; needs a tool to be installed" if _needs_tool(file) else ""
    title = (
        f"{file.path.name}: FMI {file.description.fmiVersion}, {' and '.join(file.interfaces)}; "
        f"for {', '.join(file.platforms)}{needs}"
    )
    return f"{title}\nnot quite by the standard: {file.invalid}" if file.invalid else title


def _needs_tool(file: FmuFile) -> bool:
    offered = file.description.coSimulation or file.description.modelExchange
    return bool(offered is not None and offered.needsExecutionTool)


def shown(trial: Trial) -> Table:
    """How it behaves."""
    table = plain_table(headed=False)
    start = ", ".join(f"{each:g}" for each in trial.start)
    after = f" after {PHASE:g} s"
    rows = {
        "deterministic": "yes, twice the same bits" if trial.deterministic else "NO",
        "speed": f"{trial.real_time_factor:.0f} × real time",
        "starts at": f"({start})" + (", its own start" if trial.warnings else ""),
        "straight ahead": f"{trial.ahead:.4g} m{after} at {V:g} m/s{trial.doubt_ahead}",
        "in a curve": f"{trial.turned:.4g} rad{after} at {OMEGA:g} rad/s{trial.doubt_turned}",
        "can be placed": {True: "yes", False: "NO, it is elsewhere then", None: "no"}[trial.placed],
    }
    for name, said in rows.items():
        table.add_row(name, said)
    return table


def told_in_toml(scenario: Scenario, trial: Trial) -> str:
    """What a scenario says of such a robot."""
    plant = scenario.plant
    assert plant.fmu is not None
    document = tomlkit.document()
    if trial.warnings:
        document["start"] = list(trial.start)
    table = tomlkit.table()
    table["fmu"] = plant.fmu.name
    tables: dict[str, Mapping[str, object]] = {**plant.names, "parameters": plant.parameters}
    for key, values in tables.items():
        if values:
            table[key] = tomlkit.inline_table()
            for ours, theirs in values.items():
                table[key][ours] = theirs
    document["plant"] = table
    return tomlkit.dumps(document)
