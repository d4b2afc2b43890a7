"""``laglab estimators``."""

from rich.console import Console
from rich.table import Table

from laglab_control import ESTIMATORS


def estimators() -> None:
    """List the estimators, and what each is."""
    table = Table("name", "what it is", box=None)
    for name, kind in ESTIMATORS.items():
        table.add_row(name, kind.description)
    Console().print(table)
