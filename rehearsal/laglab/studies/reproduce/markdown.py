"""The report as Markdown."""

from collections.abc import Sequence
from textwrap import fill

from laglab.studies.reproduce.entry import TITLE, Entry, opening

WIDTH = 118


def markdown(of: Sequence[Entry], pictures: str) -> str:
    """A table of the verdicts, and a section for each claim; `pictures` is their folder."""
    rows = [
        f"| [{entry.claim.name}](#{entry.claim.name}) | {entry.claim.place} | {entry.spelled} |"
        for entry in of
    ]
    table = "\n".join(["| claim | where | verdict |", "|---|---|---|", *rows])
    sections = [_section(entry, pictures) for entry in of]
    said = fill(opening(of) + " Made by `laglab reproduce`.", WIDTH)
    return "\n\n".join([f"# {TITLE}", said, table, *sections]) + "\n"


def _section(entry: Entry, pictures: str) -> str:
    claim = entry.claim
    parts = [
        f"## {claim.name}",
        fill(f"*{claim.place[0].upper()}{claim.place[1:]}:* {claim.says}", WIDTH),
        fill(entry.got, WIDTH),
        fill(f"**{entry.sign} {entry.spelled}.** {entry.claim.why}".strip(), WIDTH),
        f"`{claim.command}`",
    ]
    if entry.picture:
        parts.append(f"![{claim.name}]({pictures}/{claim.name}.png)")
    return "\n\n".join(parts)
