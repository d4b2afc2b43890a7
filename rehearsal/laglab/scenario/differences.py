"""In which keys scenarios differ."""

from collections.abc import Sequence

from laglab.scenario.explain import NOT_SET, spelled
from laglab.scenario.keys import rows
from laglab.scenario.model import Scenario

OF_NO_CONSEQUENCE = {"name", "description"}


def differing(scenarios: Sequence[Scenario]) -> dict[str, list[str]]:
    """Dotted key → what each scenario has there, spelled as in a file; keys on which all agree are
    left out."""
    tables = [
        {row.place: spelled(row.value) for row in rows(scenario) if row.key.table is None}
        for scenario in scenarios
    ]
    places = dict.fromkeys(place for table in tables for place in table)
    found = {place: [table.get(place, NOT_SET) for table in tables] for place in places}
    return {
        place: values
        for place, values in found.items()
        if len(set(values)) > 1 and place not in OF_NO_CONSEQUENCE
    }
