"""Where each station still gets the robot to its goal: on bad links, with a robot that is not the
model's, and when somebody moves it."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from laglab.scenario import Overrides, both_ways, load
from laglab.studies.judged import ALARMS
from laglab.studies.sweep.study import Study

DEFAULT = "delayed-ekf"
"""The filter of `lab*`, which is guarded there."""
STOCK = ("delayed-ekf", "popf", "ekf")
"""Compared as they are."""
MOVED_AT = 5.0
"""[s] When somebody moves the robot by half a metre."""


JITTER = {"distribution": "exponential", "mean": 0.05}
OUTAGES = [{"at": at, "duration": 1.0, "link": {"loss": 1.0}} for at in (2.0, 6.0)]
EVERYTHING = both_ways(
    loss=0.3, extra_delay=JITTER, reorder=0.2, duplicate=0.02, bit_error_rate=1e-5, bandwidth=115200
)


Station = dict[str, str | bool]
"""What makes a station: scenario keys."""


class Condition(NamedTuple):
    """A scenario, and what is different."""

    scenario: str
    overrides: Overrides


CONDITIONS: Mapping[str, Condition] = {
    "lab": Condition("lab", {}),
    "lab-radio": Condition("lab-radio", {}),
    "lab-real": Condition("lab-real", {}),
    "30 % loss": Condition("lab", both_ways(loss=0.3)),
    "50 ms jitter": Condition("lab", both_ways(extra_delay=JITTER)),
    "20 % reordered": Condition("lab", both_ways(reorder=0.2)),
    "two outages of 1 s": Condition("lab", {"link.event": OUTAGES}),
    "all of these": Condition("lab", {**EVERYTHING, "link.event": OUTAGES}),
    "wheels 10 % large": Condition("lab", {"plant.wheel_radius_error": 0.1}),
    "wheels 10 % small": Condition("lab", {"plant.wheel_radius_error": -0.1}),
    "track 10 % wide": Condition("lab", {"plant.track_error": 0.1}),
    "track 10 % narrow": Condition("lab", {"plant.track_error": -0.1}),
    "moved by 0.5 m": Condition("lab", {"plant.event": [{"at": MOVED_AT, "by": [0.3, -0.4, 0.0]}]}),
}


def stations(default: str) -> dict[str, Station]:
    """The default station, `popf` with a guard, and the filters as they are."""
    return {
        f"{default}, guarded": {"estimator.kind": default, "estimator.guard": True},
        "popf, guarded": {"estimator.kind": "popf", "estimator.guard": True},
        **{name: {"estimator.kind": name, "estimator.guard": False} for name in STOCK},
    }


Pair = tuple[str, str]
"""A condition and a station."""


def studies(
    conditions: Sequence[str], compared: Mapping[str, Station], seeds: int
) -> dict[Pair, Study]:
    """Every condition with every station, each over the same seeds."""
    return {
        (condition, station): _study(condition, station, how, seeds)
        for condition in conditions
        for station, how in compared.items()
    }


def _study(condition: str, station: str, how: Station, seeds: int) -> Study:
    """Of one point: what is different stands in its grid, and so in what is said of its runs."""
    base, different = CONDITIONS[condition]
    told = {**different, **how}
    if str(how["estimator.kind"]).startswith("popf"):
        told["estimator.initial_covariance"] = 1e-4
    grid = {key: (value,) for key, value in told.items()}
    name = f"{condition}, {station}"
    return Study(load(base), range(1, seeds + 1), grid, name=name, also=ALARMS)
