"""What each column of each table of a run is: the one place that says it."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

COUNTED = ("ticks", "1", "byte")


class Column(NamedTuple):
    """One column: its name, its unit (1: a number without one, -: no number), what it is."""

    name: str
    unit: str
    sentence: str

    @property
    def kind(self) -> type[int | float | str]:
        """Of its cells."""
        return str if self.unit == "-" else int if self.unit in COUNTED else float


def _pose(suffix: str, whose: str) -> Iterator[Column]:
    for axis, unit in (("x", "m"), ("y", "m"), ("theta", "rad")):
        yield Column(axis + suffix, unit, whose)


def _covariance(suffix: str, whose: str) -> Iterator[Column]:
    names = {"x": "x", "y": "y", "t": "θ"}
    units = {"x": "m", "y": "m", "t": "rad"}
    for a, b in ("xx", "xy", "xt", "yy", "yt", "tt"):
        of = f"Variance of {names[a]}" if a == b else f"Covariance of {names[a]} and {names[b]}"
        unit = f"{units[a]}²" if a == b else "m²" if units[a] == units[b] else "m rad"
        yield Column(f"p_{a}{b}{suffix}", unit, f"{of}, {whose}.")


TICK = Column("tick", "ticks", "k, the number of the tick.")
TIME = Column("time", "s", "The tick's time since the run's first.")
CLAIMED = "as the station claims for its estimate of tick k"

TRACE = (
    TICK,
    TIME,
    *_pose("", "The true pose at tick k; nothing of a real robot."),
    *_pose("_meas", "The measurement sampled at tick k, whether it came across or not."),
    *_pose("_est", "The estimate of tick k by the filter in the loop."),
    Column("v_sent", "m/s", "The forward speed that the station commanded at tick k."),
    Column("omega_sent", "rad/s", "The turn rate that the station commanded at tick k."),
    Column("v", "m/s", "The forward speed in force from tick k to the next."),
    Column("omega", "rad/s", "The turn rate in force from tick k to the next."),
)
LINK = (
    Column("direction", "-", "`command` or `measurement`."),
    Column("tick", "ticks", "The tick in which the frame entered the link."),
    Column("frame", "1", "Its number in that tick, from 0."),
    Column("copy", "1", "Which copy of it, from 0: the link may double a frame."),
    Column("size", "byte", "Its length."),
    Column(
        "fate",
        "-",
        "`delivered`, `lost`, `burst` (lost in a bad spell), `outage`, `queue-full`, `corrupted`, "
        "`late` (delivered too late for play-out).",
    ),
    Column("extra", "s", "How much later than the fixed delay."),
)
ARRIVALS = (
    Column("direction", "-", "`command` or `measurement`."),
    Column("tick", "ticks", "The tick that the message is stamped with."),
    Column("arrived", "ticks", "The tick at which it came out of the link."),
    Column("time", "s", "That tick's time since the run's first."),
    Column("refused", "-", "Why the robot did not follow the command; `no`: it did."),
)
CLAIMS = (TICK, TIME, *_covariance("", CLAIMED))
TIMING = (
    TICK,
    Column("lateness", "s", "How long after its deadline the tick began."),
    Column("answer", "s", "How long after that the station's answer came; nothing: not in time."),
)
SHADOW = (
    TICK,
    *_pose("", "The estimate of tick k by the filter NAME, which shadowed the loop."),
    *_covariance("", "as the filter NAME claims"),
)

FILES: Mapping[str, Sequence[Column]] = {
    "trace.csv": TRACE,
    "link.csv": LINK,
    "arrivals.csv": ARRIVALS,
    "claims.csv": CLAIMS,
    "timing.csv": TIMING,
    "shadow-NAME.csv": SHADOW,
}
"""The tables that a run leaves, each with its columns in order."""


def tick_columns(shadows: Sequence[str]) -> tuple[Column, ...]:
    """All that is known of a tick, side by side; with what these estimators said of it."""
    return (*TRACE, *CLAIMS[2:], *TIMING[1:], *(each for name in shadows for each in _of(name)))


def _of(name: str) -> Iterator[Column]:
    for column in SHADOW[1:]:
        yield Column(f"{column.name}_{name}", column.unit, column.sentence.replace("NAME", name))
