"""What came of each item, as a table and as JUnit XML."""

from enum import Enum
from typing import NamedTuple
from xml.etree import ElementTree


class Mark(Enum):
    """What came of one item."""

    PASSED = "passed"
    FAILED = "FAILED"
    SKIPPED = "skipped"
    INTERRUPTED = "interrupted"
    """Somebody ended it all before it was through."""


class Result(NamedTuple):
    """One item, such as "crc: a corrupted frame is refused", and why it was not passed."""

    group: str
    name: str
    mandatory: bool
    mark: Mark
    reason: str
    seconds: float


class Report(NamedTuple):
    """All items of one side."""

    side: str
    results: tuple[Result, ...]

    @property
    def conforms(self) -> bool:
        """Whether every mandatory item was passed or did not apply; none was left out."""
        return self.is_whole and not any(map(_counts, self.results))

    @property
    def tried(self) -> bool:
        """Whether anything was."""
        return any(each.mark in (Mark.PASSED, Mark.FAILED) for each in self.results)

    @property
    def is_whole(self) -> bool:
        """Whether nobody ended it before its time."""
        return not any(each.mark is Mark.INTERRUPTED for each in self.results)

    @property
    def failed(self) -> list[str]:
        """The names of the items that were not passed."""
        return [each.name for each in self.results if each.mark is Mark.FAILED]

    def table(self) -> str:
        """For a person: a line an item, and the verdict."""
        width = max((len(each.name) for each in self.results), default=0)
        lines = [
            f"{each.group:10} {each.name:{width}}  "
            f"{'mandatory' if each.mandatory else 'optional':9}  {each.mark.value}"
            + (f": {each.reason}" if each.reason else "")
            for each in self.results
        ]
        verdict = "conforms" if self.conforms else "does not conform"
        verdict = verdict if self.is_whole else "was not tested to the end"
        return "\n".join([*lines, f"the {self.side} {verdict}"])

    def junit(self) -> str:
        """For a build server; a failed optional item is told as skipped."""
        suite = ElementTree.Element(
            "testsuite",
            name=f"laglab conform {self.side}",
            tests=str(len(self.results)),
            failures=str(sum(map(_counts, self.results))),
        )
        for each in self.results:
            case = ElementTree.SubElement(
                suite,
                "testcase",
                classname=f"{self.side}.{each.group}",
                name=each.name,
                time=f"{each.seconds:.3f}",
            )
            if each.mark is not Mark.PASSED:
                tag = "failure" if _counts(each) else "skipped"
                ElementTree.SubElement(case, tag, message=each.reason)
        return ElementTree.tostring(suite, encoding="unicode", xml_declaration=True)


def _counts(result: Result) -> bool:
    return result.mandatory and result.mark is Mark.FAILED
