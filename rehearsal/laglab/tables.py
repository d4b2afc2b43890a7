"""Every table of the command line: one style, within 80 columns, readable in narrower ones."""

from rich.console import Console
from rich.table import Table


def terminal(stderr: bool = False) -> Console:
    """Where commands print. What others have written, names and messages, is printed as it is:
    brackets in it are no markup, nor colons an emoji."""
    return Console(stderr=stderr, markup=False, emoji=False)


def say(text: str) -> None:
    """A line on standard error."""
    terminal(stderr=True).print(text, highlight=False, soft_wrap=True)


def counted(count: int, what: str) -> str:
    """So many of them; `what` is the word for one, which takes an s."""
    return f"{count} {what}" + ("" if count == 1 else "s")


def plain_table(*headings: str, title: str = "", caption: str = "", headed: bool = True) -> Table:
    """Without lines: title and caption at the left, headings, a row a line. Numbers are put at the
    right by who adds their columns."""
    return Table(
        *headings,
        title=title or None,
        caption=caption or None,
        title_justify="left",
        caption_justify="left",
        show_header=headed,
        box=None,
        pad_edge=False,
        padding=(0, 1, 0, 0),
    )
