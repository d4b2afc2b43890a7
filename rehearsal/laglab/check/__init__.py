"""Whether what somebody brings keeps the interface: a row for each thing that can be wrong."""

from laglab.check.apart import CheckOrder, checked_apart
from laglab.check.checking import checked
from laglab.check.finding import Finding, all_hold, findings_table
from laglab.check.subject import KINDS, SHIPPED, Kind, kind_of

__all__ = [
    "KINDS",
    "SHIPPED",
    "CheckOrder",
    "Finding",
    "Kind",
    "all_hold",
    "checked",
    "checked_apart",
    "findings_table",
    "kind_of",
]
