"""``laglab scenario``."""

from typing import Annotated

import typer

from laglab.commands.on_scenario import on_scenario
from laglab.files import here
from laglab.scenario import Scenario


def _print_schema(wanted: bool) -> None:
    if wanted:
        from laglab.scenario.reference import schema

        typer.echo(schema(), nl=False)
        raise typer.Exit


@on_scenario
def scenario(
    scenario: Scenario,
    explain: Annotated[
        bool, typer.Option("--explain", help="Every key: value, unit, default, what it is for.")
    ] = False,
    schema: Annotated[  # noqa: ARG001 its callback does it, without a scenario
        bool,
        typer.Option(
            "--schema",
            help="The JSON Schema for editors instead; needs no SCENARIO.",
            is_eager=True,
            callback=_print_schema,
        ),
    ] = False,
) -> None:
    """Print SCENARIO whole, as TOML, with what the options change."""
    if explain:
        from laglab.scenario.explain import explained

        typer.echo(explained(scenario))
    else:
        typer.echo(scenario.to_toml(here()), nl=False)
