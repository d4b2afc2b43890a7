"""`[estimator]`: which filter, and what it is told of the start."""

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from laglab.scenario.tables.names import known_estimator, offered
from laglab.scenario.tables.table import POSE, Options, OptionsTable, Pose, Table
from laglab_control import ESTIMATORS, StationConfig
from laglab_gateway.values import NotNegative, Switch, described, saying


def comparable(name: str) -> str:
    """The name of an estimator. Raises ValueError for one that estimates nothing."""
    if name in ESTIMATORS and not ESTIMATORS[name].predicts:
        raise ValueError(f"must not be {name!r}, which estimates nothing that could be compared")
    return known_estimator(name)


COMPARABLE = [name for name, kind in ESTIMATORS.items() if kind.predicts]
EstimatorName = Annotated[str, AfterValidator(known_estimator), offered(ESTIMATORS)]
ComparedName = Annotated[
    str, AfterValidator(comparable), offered(COMPARABLE, set(ESTIMATORS) - set(COMPARABLE))
]


class EstimatorTable(Table):
    """The filter in the loop, those that look on, and their prior."""

    kind: Annotated[
        EstimatorName,
        described(
            "-",
            f"The filter in the loop: {', '.join(ESTIMATORS)}, an installed plug-in's name, or "
            "`module:Class`.",
        ),
    ] = StationConfig.estimator
    compare: Annotated[
        tuple[ComparedName, ...],
        described("-", "Filters that are run on the same record, to be compared with it."),
    ] = ()
    initial_covariance: Annotated[
        NotNegative,
        described(
            "m², m², rad²", "The filter's variance of x, y and θ at first: P_0 is this times I."
        ),
    ] = 1e-4
    initial_estimate: Annotated[
        Literal["start", "drawn"] | Pose,
        saying("'start', 'drawn' or three finite numbers, x, y and theta"),
        described(
            POSE,
            "The filter's first pose: `start`, the robot's; `drawn` about it, by P_0; or a pose.",
        ),
    ] = "start"
    guard: Annotated[
        Switch,
        described(
            "-",
            "Whether measurements that the estimate cannot explain raise an alarm, after which "
            "the pose is found again; a single wild one is not used.",
        ),
    ] = StationConfig.guard
    options: Annotated[
        Options,
        described("-", "What a filter that is none of ours is told besides the robot's model."),
    ] = Field(default_factory=OptionsTable)
