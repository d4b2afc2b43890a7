"""Links measured by others: files recognised by what is in them."""

from laglab.link.importing.how import How
from laglab.link.importing.recognise import read_link
from laglab.link.importing.tables import read_table

__all__ = ["How", "read_link", "read_table"]
