"""`laglab plant`."""

from pathlib import Path
from typing import Annotated, Any

import typer

from laglab.commands.group import group
from laglab.errors import ScenarioError
from laglab.extras import STEPPING, require
from laglab.progress import status
from laglab.runs.plant import check_plant
from laglab.scenario import Overrides, Scenario, assignment, changed, load
from laglab.tables import terminal
from laglab_control import is_module_class

app = group("A robot of your own.")


@app.command()
def check(
    file: Annotated[
        str, typer.Argument(metavar="FILE", help="An FMU, or a scenario that names a robot.")
    ],
    set_: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            help="A key of the scenario, such as plant.outputs.x=NAME; beats what is proposed.",
        ),
    ] = None,
) -> None:
    """Look at a robot, and drive it.

    Of an FMU it lists what could be mapped, proposes a map, drives it, and prints the TOML to use.
    The exit code is 1 when something is not as it must be, 2 when it cannot be used at all.
    """
    require(STEPPING)
    if is_module_class(file) and not Path(file).exists():
        raise typer.BadParameter(f"{file} is a class: `laglab check {file}` looks at it")
    from laglab.plants import Proposal, proposed, tried
    from laglab.plants.report import headed, offered, shown, told_in_toml
    from laglab_fmu.foreign import FmuFile

    overrides = dict(map(assignment, set_ or []))
    console = terminal()
    fmu = FmuFile.read(Path(file)) if Path(file).suffix == ".fmu" else None
    proposal = proposed(fmu) if fmu else Proposal()
    if fmu:
        print(headed(fmu))
        console.print(offered(fmu, proposal), highlight=False)
    scenario = _of_fmu(fmu.path, proposal.fields(), overrides) if fmu else load(file, overrides)
    check_plant(scenario)
    with status() as tell:
        tell("driving it")
        trial = tried(scenario)
    if fmu:
        print()
    console.print(shown(trial), highlight=False)
    if scenario.plant.fmu:
        print()
        print(told_in_toml(scenario, trial), end="")
    if not trial.is_fine:
        raise typer.Exit(1)


def _of_fmu(path: Path, plant: dict[str, Any], overrides: Overrides) -> Scenario:
    """Raises ScenarioError, naming what the proposal lacks."""
    fields = {f"plant.{key}": value for key, value in plant.items()}
    try:
        return changed(Scenario(name=path.name), {"plant.fmu": str(path), **fields, **overrides})
    except ScenarioError as error:
        if {"inputs", "outputs"} <= plant.keys():
            raise
        raise ScenarioError(
            f"{path}: its names do not say which are the command and the pose: say it, such as "
            f"--set plant.inputs.v=NAME --set plant.inputs.omega=NAME ({error})"
        ) from None
