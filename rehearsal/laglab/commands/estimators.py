"""``laglab estimators``."""

from rich.console import Console

from laglab.tables import plain_table
from laglab_control import ESTIMATORS


def estimators() -> None:
    """List the estimators, and what each is."""
    table = plain_table("name", "what it is")
    for name, kind in ESTIMATORS.items():
        table.add_row(name, kind.description)
    Console().print(table)
