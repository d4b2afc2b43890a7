"""``laglab scenarios``."""

from laglab.scenario import shipped
from laglab.tables import plain_table, terminal


def scenarios() -> None:
    """List the scenarios that come with laglab."""
    table = plain_table("name", "estimator", "n", "m", "noise", "what it shows")
    for name, scenario in shipped().items():
        table.add_row(
            name,
            scenario.estimator.kind,
            str(scenario.link.command_delay),
            str(scenario.link.measurement_delay),
            "on" if scenario.noise else "off",
            scenario.description,
        )
    terminal().print(table)
