"""``laglab plants``."""

from rich.console import Console

from laglab.scenario.tables.plant import SHIPPED
from laglab.tables import plain_table
from laglab_control.plugins import installed_plugins


def plants() -> None:
    """List the robots that are installed here."""
    table = plain_table("name", "origin", "what it is")
    for name, description in SHIPPED.items():
        table.add_row(name, "laglab", description)
    for plugin in installed_plugins("laglab.plants"):
        table.add_row(*plugin)
    Console().print(table)
