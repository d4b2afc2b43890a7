"""What every command that makes a run leaves of it: a folder, a page, and the verdict."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple

from laglab.commands.runs.live import shown_live
from laglab.commands.runs.verdict import conclude
from laglab.extras import SEEING, require
from laglab.live import LivePage
from laglab.results.complete import Manner
from laglab.results.place import place, withdrawn_unless_begun
from laglab.runs.ending import Ending
from laglab.scenario import Scenario


class Wishes(NamedTuple):
    """What the user wants to have of a run, by the options' names."""

    out: Path | None
    force: bool
    report: bool
    live: str | None
    open_: bool

    def check(self) -> None:
        """Raises MissingExtraError: what draws them is not installed."""
        if self.report:
            require(SEEING)


class Leaving(NamedTuple):
    """What a run that is about to begin will leave."""

    scenario: Scenario
    manner: Manner
    directory: Path
    report: bool
    page: LivePage | None
    last: ExitStack
    """What is entered here is left when the results are written."""

    @property
    def line(self) -> str | None:
        """To the live page, if there is one."""
        return self.page.line if self.page else None

    def conclude(self, ending: Ending) -> int:
        """Write the results and show them; the exit code. Raises what `verdict.conclude` does."""
        return conclude(self.scenario, self.manner, ending, self.directory, self.report, self.page)


@contextmanager
def leaving(
    scenario: Scenario, manner: Manner, wishes: Wishes, suffix: str = ""
) -> Iterator[Leaving]:
    """Its page shown and its folder made. Raises LiveError and PlaceError."""
    with shown_live(scenario, manner, wishes.live, wishes.open_) as page:
        directory = place(scenario, wishes.out, wishes.force, suffix)
        with withdrawn_unless_begun(directory), ExitStack() as last:
            yield Leaving(scenario, manner, directory, wishes.report, page, last)
