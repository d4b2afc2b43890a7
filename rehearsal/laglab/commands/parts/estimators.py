"""``laglab estimators``, ``laglab laws`` and ``laglab plants``."""

from collections.abc import Mapping

from laglab.scenario.tables.plant import SHIPPED
from laglab.tables import plain_table, terminal
from laglab_control import ESTIMATORS, LAWS, installed_plugins
from laglab_control.plugins import Group


def estimators() -> None:
    """List the estimators, shipped and installed."""
    _list("laglab.estimators", {name: kind.description for name, kind in ESTIMATORS.items()})


def laws() -> None:
    """List the control laws, shipped and installed."""
    _list("laglab.laws", LAWS)


def plants() -> None:
    """List the robots, shipped and installed."""
    _list("laglab.plants", SHIPPED)


def _list(group: Group, shipped: Mapping[str, str]) -> None:
    table = plain_table()
    for heading in ("name", "from", "what it is"):
        table.add_column(heading, overflow="fold")
    for name, description in shipped.items():
        table.add_row(name, "laglab", description)
    for plugin in installed_plugins(group):
        table.add_row(*plugin)
    terminal().print(table, highlight=False)
