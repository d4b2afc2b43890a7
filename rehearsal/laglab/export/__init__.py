"""What a run left, in the formats that other programs read."""

from laglab.export.formats import FormatName, export

__all__ = ["FormatName", "export"]
