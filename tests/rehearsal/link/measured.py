"""A file of what others measured, imported."""

from pathlib import Path

from laglab.link.importing import How, read_link
from laglab.link.measured import MeasuredLink
from laglab.link.probing import Sizes

HOW = How(Sizes(121, 75))


def imported(tmp_path: Path, data: str | bytes, how: How = HOW) -> MeasuredLink:
    path = tmp_path / "measured"
    path.write_bytes(data.encode() if isinstance(data, str) else data)
    return read_link(path, how)
