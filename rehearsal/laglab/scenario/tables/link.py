"""`[link]`: the way between robot and station."""

from pathlib import Path
from typing import Annotated, Self

from pydantic import AfterValidator, Field, model_validator

from laglab.scenario.tables.table import Table
from laglab_gateway import IDEAL, Event, Impairments, TimelineError, read_link_log
from laglab_gateway.values import Ticks, Whole, described
from laglab_protocol import LONGEST_PLAN, UNKNOWN_DELAY

Delay = Annotated[Ticks, Field(lt=UNKNOWN_DELAY)]
"""[ticks] Within what the two sides can tell each other."""


def _readable(log: Path) -> Path:
    try:
        told = read_link_log(log)
    except TimelineError as error:
        raise ValueError(str(error)) from error
    if not any(told.values()):
        raise ValueError(f"{log} tells of no frame: an ideal link leaves no trace, nor needs one")
    return log.resolve()


class PlayoutTable(Table):
    """What comes early is held until it is as late as this; what comes later is dropped."""

    command: Annotated[
        Delay,
        described(
            "ticks", "So long after its stamp the robot follows a command; 0: when it comes."
        ),
    ] = 0
    measurement: Annotated[
        Delay,
        described(
            "ticks", "So long after its sampling the station uses a measurement; 0: when it comes."
        ),
    ] = 0


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
    playout: Annotated[
        PlayoutTable, described("-", "Whether both ends hide the link's jitter, and how far.")
    ] = PlayoutTable()
    plan: Annotated[
        Whole,
        Field(ge=0, le=LONGEST_PLAN),
        described(
            "ticks",
            "How far each command plans ahead, H: the robot goes on by the newest plan that it has "
            "while nothing newer comes; 0: it has no plans, and holds the last command.",
        ),
    ] = 0
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

    @model_validator(mode="after")
    def _in_time(self) -> Self:
        for direction in ("command", "measurement"):
            bound, delay = getattr(self.playout, direction), getattr(self, f"{direction}_delay")
            if 0 < bound < delay:
                raise ValueError(
                    f"playout.{direction}: must be {delay} or more, the delay of the link, below "
                    f"which all would be late, or 0, not {bound}"
                )
        return self

    @property
    def n(self) -> int:
        """Ticks from a command's stamp until it is in force: the link's, or play-out's."""
        return self.playout.command or self.command_delay

    @property
    def m(self) -> int:
        """Ticks from the sampling of a measurement until it is used: the link's, or play-out's."""
        return self.playout.measurement or self.measurement_delay
