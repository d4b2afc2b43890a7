"""What is wrong with a scenario, in one line that names the key as it stands in the file."""

from collections.abc import Sequence
from difflib import get_close_matches

from pydantic import ValidationError

from laglab.scenario.keys import ANY, NO_UNIT, keys, rows
from laglab.scenario.model import Scenario
from laglab_gateway.values import wording

Location = Sequence[int | str]
UNKNOWN = ("extra_forbidden", "unexpected_keyword_argument")
LIKE = 0.7
"""How much alike two names must be (difflib's ratio) for one to be taken for the other."""


def first_problem(error: ValidationError) -> str:
    """The key, what it must be and what it is."""
    problem = error.errors()[0]
    place = _place(problem["loc"])
    text = _unknown(place) if problem["type"] in UNKNOWN else wording(problem)
    if _unit(place) == "ticks":
        text = text.replace("a whole number", "a whole number of ticks")
    return f"{place}: {text}" if place else text


def _unit(place: str) -> str:
    return next((row.key.unit for row in rows() if row.place == _pattern(place)), NO_UNIT)


def _place(location: Location) -> str:
    """The dotted keys, as far as they name tables: what follows is inside of a value."""
    parts: list[str] = []
    table: type | None = Scenario
    for part in location:
        if table is None:
            break
        parts.append(str(part))
        if isinstance(part, str):
            table = {key.name: key.table for key in keys(table)}.get(part)
    return ".".join(parts)


def _unknown(place: str) -> str:
    above, _, name = place.rpartition(".")
    near = _near(above, name)
    if near:
        return f"unknown key; did you mean {' or '.join(near)}?"
    pattern = _pattern(above)
    known = [row.key.name for row in rows() if row.place.rpartition(".")[0] == pattern]
    return f"unknown key; known here: {', '.join(known)}"


def _near(above: str, name: str, most: int = 3) -> list[str]:
    """Keys of a like name, those of the same table first."""
    by_place = {row.place: row.key.name for row in rows()}
    alike = get_close_matches(name, set(by_place.values()), most, LIKE)
    found = [place for each in alike for place, known in by_place.items() if known == each]
    pattern = _pattern(above)
    return sorted(found, key=lambda place: place.rpartition(".")[0] != pattern)[:most]


def _pattern(place: str) -> str:
    """With ANY in the place of a number."""
    return ".".join(ANY if part.isdigit() else part for part in place.split("."))
