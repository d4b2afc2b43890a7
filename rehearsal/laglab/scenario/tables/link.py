"""`[link]`: the way between robot and station."""

from pathlib import Path
from typing import Annotated

from pydantic import AfterValidator, Field

from laglab.scenario.tables.table import Table
from laglab_gateway import IDEAL, Event, Impairments, TimelineError, read_link_log
from laglab_gateway.values import Ticks, described
from laglab_protocol import UNKNOWN_DELAY

Delay = Annotated[Ticks, Field(lt=UNKNOWN_DELAY)]
"""As the two sides can tell each other."""


def _readable(log: Path) -> Path:
    try:
        read_link_log(log, "command")
    except TimelineError as error:
        raise ValueError(str(error)) from error
    return log.resolve()


class LinkTable(Table):
    """The two delays, and what the link does besides: nothing, by default."""

    command_delay: Annotated[
        Delay, described("ticks", "How late a command comes into force, n.")
    ] = 10
    measurement_delay: Annotated[
        Delay, described("ticks", "How late a measurement reaches the station, m.")
    ] = 20
    command: Annotated[Impairments, described("-", "What else the link does to commands.")] = IDEAL
    measurement: Annotated[
        Impairments, described("-", "What else the link does to measurements.")
    ] = IDEAL
    event: Annotated[
        tuple[Event, ...],
        described("-", "Times at which the link is another; where they overlap, the last wins."),
    ] = ()
    replay: Annotated[
        Annotated[Path, AfterValidator(_readable)] | None,
        described(
            "-",
            "The `link.csv` of a run or a measurement, relative to the scenario's folder: what "
            "happened to its frames happens again, and nothing else; a longer run goes through it "
            "again.",
        ),
    ] = None
