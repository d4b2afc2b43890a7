"""``laglab scenarios``."""

from rich.console import Console
from rich.table import Table

from laglab.scenario import shipped


def scenarios() -> None:
    """List the scenarios that come with laglab."""
    table = Table("name", "estimator", "n", "m", "noise", "what it shows", box=None)
    for name, scenario in shipped().items():
        table.add_row(
            name,
            scenario.estimator.kind,
            str(scenario.link.command_delay),
            str(scenario.link.measurement_delay),
            "on" if scenario.noise else "off",
            scenario.description,
        )
    Console().print(table)
