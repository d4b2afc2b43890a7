"""The options that every command on a scenario shares: command line beats file."""

import inspect
from collections.abc import Callable, Iterator
from typing import Annotated, Any, NamedTuple

import typer

from laglab.errors import ScenarioError
from laglab.scenario import Overrides, Scenario, assignment, load, read_timeline, shipped_names
from laglab.scenario.keys import NO_UNIT, rows
from laglab.scenario.tables.plant import TWO_WHEELS
from laglab.tables import say
from laglab_control import ESTIMATORS

ScenarioArgument = Annotated[
    str,
    typer.Argument(
        metavar="SCENARIO",
        help="A shipped scenario's name, or a TOML file.",
        autocompletion=shipped_names,
    ),
]
EstimatorsOption = Annotated[
    list[str] | None,
    typer.Option(
        "--estimator",
        metavar="NAME",
        help=f"The filter in the loop; further ones shadow it: {', '.join(ESTIMATORS)}, a plug-in "
        "or module:Class.",
        autocompletion=lambda: list(ESTIMATORS),
    ),
]

POSE = "X,Y,THETA"


class Own(NamedTuple):
    """A key's own option: its type on the command line, and how it is written."""

    type: object
    name: str
    metavar: str | None = None


OWN: dict[str, Own] = {
    "link.command_delay": Own(int | None, "-n"),
    "link.measurement_delay": Own(int | None, "-m"),
    "start": Own(str | None, "--start", POSE),
    "goal": Own(str | None, "--goal", POSE),
    "seed": Own(int | None, "--seed"),
    "noise": Own(bool | None, "--noise/--no-noise"),
    "duration": Own(float | None, "--duration"),
    "estimator.initial_covariance": Own(float | None, "--p0"),
    "estimator.initial_estimate": Own(str | None, "--initial-estimate", POSE),
    "law.kind": Own(str | None, "--law", "NAME"),
    "law.path": Own(str | None, "--path", "PATH"),
    "law.v_max": Own(float | None, "--v-max"),
    "law.omega_max": Own(float | None, "--omega-max"),
    "law.goal_tolerance": Own(float | None, "--goal-tolerance"),
    "pace": Own(str | None, "--pace"),
    "speed": Own(float | None, "--speed"),
    "silence_timeout": Own(float | None, "--silence"),
    "plant.fmi": Own(int | None, "--fmi"),
}
"""Dotted key of a scenario → its option, which says what the key says."""
OF_A_SIMULATED_ROBOT = (
    "pace",
    "speed",
    "plant.kind",
    "plant.fmi",
    "plant.fmu",
    "plant.integration",
    "plant.options",
    "plant.parameters",
    "plant.inputs",
    "plant.outputs",
    "plant.start",
    *(f"plant.{key}" for key in TWO_WHEELS),
)
"""Keys, and tables, that nobody reads in front of a real one."""
OF_THE_POLAR_LAW = ("law.gamma", "law.lambda", "law.h", "law.goal_tolerance")
"""Keys that no other law reads."""
OF_SEVERAL_KEYS: dict[str, Any] = {
    "estimator": EstimatorsOption,
    "timeline": Annotated[
        str | None,
        typer.Option(
            "--timeline",
            metavar="FILE",
            help="What the link does when: TOML, or a link.csv, of a run or measured; a longer run "
            "goes through it again.",
        ),
    ],
    "set": Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            help="Any key of a scenario, such as link.command.loss=0.1; may be repeated. "
            "It beats the file, and a key's own option beats it.",
        ),
    ],
}


def _overrides(options: dict[str, Any]) -> dict[str, object]:
    """What beats the file; takes the options that say so out of `options`."""
    own = {key: options.pop(_parameter(key)) for key in OWN}
    own = {key: value for key, value in own.items() if value is not None}
    if names := options.pop("estimator", None):
        own |= {"estimator.kind": names[0]}
        own |= {"estimator.compare": names[1:]} if names[1:] else {}
    if timeline := options.pop("timeline"):
        own |= read_timeline(timeline)
    told = dict(map(assignment, options.pop("set") or []))
    return {key: value for key, value in told.items() if key not in own} | own


def _parameter(key: str) -> str:
    return key.replace(".", "_")


def _parameters(by_default: object, estimators: bool) -> Iterator[inspect.Parameter]:
    """SCENARIO, and the options that override it."""
    keyword = inspect.Parameter.KEYWORD_ONLY
    yield inspect.Parameter("scenario", keyword, default=by_default, annotation=ScenarioArgument)
    for name, hint in OF_SEVERAL_KEYS.items():
        if name == "estimator" and not estimators:
            continue
        yield inspect.Parameter(name, keyword, default=None, annotation=hint)
    said = {row.place: row.key for row in rows()}
    for key, own in OWN.items():
        unit = said[key].unit
        text = said[key].sentence + (f" [{unit}]" if unit != NO_UNIT else "")
        option = typer.Option(None, own.name, metavar=own.metavar, help=text, show_default=False)
        yield inspect.Parameter(_parameter(key), keyword, default=option, annotation=own.type)


def _before_real_robot(overrides: Overrides, address: str) -> Overrides:
    """With its own pace, which is the clock's. Raises ScenarioError: nobody would read what
    somebody asks for."""
    tables = tuple(f"{key}." for key in OF_A_SIMULATED_ROBOT)
    if idle := sorted(
        key for key in overrides if key in OF_A_SIMULATED_ROBOT or key.startswith(tables)
    ):
        raise ScenarioError(
            f"{idle[0]}: the robot at {address} has a clock of its own, and is what it is: leave "
            "it out, or --plant"
        )
    return {**overrides, "pace": "realtime", "speed": 1.0}


def _loaded(name: str, overrides: Overrides) -> Scenario:
    """Raises ScenarioError also where nobody would read what somebody asks for."""
    loaded = load(name, overrides, say)
    for key, why in _idle(loaded):
        if key in overrides:
            raise ScenarioError(f"{key}: {why}")
    return loaded


def _idle(scenario: Scenario) -> Iterator[tuple[str, str]]:
    """Keys that nobody reads in such a scenario: why, and what to do."""
    if not scenario.plant.ships:
        yield "plant.fmi", f"{scenario.plant.called} is as it was brought: leave --fmi out"
    if scenario.law.kind != "polar":
        for key in OF_THE_POLAR_LAW:
            yield key, f"the law {scenario.law.kind} knows none: leave it out"


def on_scenario(
    command: Callable[..., None],
    by_default: object = inspect.Parameter.empty,
    estimators: bool = True,
) -> Callable[..., None]:
    """Give ``command(scenario, …)`` the SCENARIO argument and the options that override it.

    `by_default` is the SCENARIO where none is named, if that is allowed; without `estimators` the
    command has its own.
    """
    own = list(inspect.signature(command).parameters.values())[1:]

    def wrapper(scenario: str, **options: Any) -> None:
        overrides: Overrides = _overrides(options)
        if real := options.get("plant"):
            overrides = _before_real_robot(overrides, real)
        command(_loaded(scenario, overrides), **options)

    keyword = inspect.Parameter.KEYWORD_ONLY
    parameters = [
        *_parameters(by_default, estimators),
        *(each.replace(kind=keyword) for each in own),
    ]
    wrapper.__name__ = command.__name__
    wrapper.__doc__ = command.__doc__
    wrapper.__annotations__ = {item.name: item.annotation for item in parameters}
    wrapper.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    return wrapper
