"""The report in files: as Markdown, and as one page."""

from collections.abc import Sequence
from pathlib import Path

from laglab.files import folder_place, write_whole
from laglab.studies.reproduce.claim import Finding
from laglab.studies.reproduce.entry import entries
from laglab.studies.reproduce.markdown import markdown
from laglab.studies.reproduce.page import page

NAME = "reproduce"


def write_report(findings: Sequence[Finding], folder: Path) -> tuple[Path, Path]:
    """`reproduce.html`, which needs nothing else, and `reproduce.md`, whose pictures are in a
    folder beside it. Raises: PlaceError, ResultsError."""
    of = entries(findings)
    pictures = folder_place("the folder", folder / NAME)
    for entry in of:
        if entry.picture:
            write_whole(pictures / f"{entry.claim.name}.png", entry.picture)
    files = folder / f"{NAME}.html", folder / f"{NAME}.md"
    for file, text in zip(files, (page(of), markdown(of, NAME)), strict=True):
        write_whole(file, text)
    return files
