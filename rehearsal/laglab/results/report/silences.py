"""When a scenario's link lets nothing pass."""

from typing import NamedTuple

from laglab.scenario import Scenario
from laglab_gateway import Impairments


class Silence(NamedTuple):
    """From when to when [s]; in which direction, or `both`."""

    start: float
    end: float
    direction: str


def silences(scenario: Scenario) -> list[Silence]:
    """Outages of either direction, and times at which all is lost."""
    link = scenario.link
    found = [*_outages(link.command, "command"), *_outages(link.measurement, "measurement")]
    for event in link.event:
        if event.link.loss == 1.0:
            found.append(Silence(event.at, event.at + event.duration, event.direction))
        found += [
            each
            for each in _outages(event.link, event.direction)
            if event.at <= each.start < event.at + event.duration
        ]
    return found


def _outages(impairments: Impairments, direction: str) -> list[Silence]:
    return [Silence(start, start + duration, direction) for start, duration in impairments.outages]
