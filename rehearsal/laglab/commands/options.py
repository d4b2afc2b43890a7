"""The options that every command on a scenario shares: command line beats file."""

import inspect
from collections.abc import Callable
from typing import Annotated, Any

import typer

from laglab.scenario import load

ScenarioArgument = Annotated[
    str, typer.Argument(metavar="SCENARIO", help="A shipped scenario's name, or a TOML file.")
]


def _option(*names: str, help: str, metavar: str | None = None) -> Any:  # noqa: A002
    return typer.Option(*names, help=help, metavar=metavar, show_default=False)


POSE = "X,Y,THETA"
OVERRIDES: dict[str, Any] = {
    "estimator": Annotated[
        list[str] | None,
        _option("--estimator", help="The filter in the loop; further ones shadow it."),
    ],
    "command_delay": Annotated[int | None, _option("-n", help="Command delay [ticks].")],
    "measurement_delay": Annotated[int | None, _option("-m", help="Measurement delay [ticks].")],
    "start": Annotated[str | None, _option("--start", help="Start pose.", metavar=POSE)],
    "goal": Annotated[str | None, _option("--goal", help="Goal pose.", metavar=POSE)],
    "seed": Annotated[int | None, _option("--seed", help="Seed of every random draw.")],
    "noise": Annotated[
        bool | None, _option("--noise/--no-noise", help="Wheel and measurement noise.")
    ],
    "duration": Annotated[float | None, _option("--duration", help="Simulated time [s].")],
    "initial_covariance": Annotated[float | None, _option("--p0", help="P_0 = VALUE·I.")],
    "initial_estimate": Annotated[
        str | None, _option("--initial-estimate", help="x̂_0.", metavar=POSE)
    ],
    "v_max": Annotated[float | None, _option("--v-max", help="Speed limit [m/s].")],
    "omega_max": Annotated[float | None, _option("--omega-max", help="Turn limit [rad/s].")],
    "goal_tolerance": Annotated[
        float | None, _option("--goal-tolerance", help="Turn on the spot inside it [m].")
    ],
    "pace": Annotated[str | None, _option("--pace", help="lockstep, or realtime.")],
    "speed": Annotated[float | None, _option("--speed", help="Real time so many times as fast.")],
    "silence_timeout": Annotated[
        float | None, _option("--silence", help="Seconds until a silent side counts as gone.")
    ],
    "timeline": Annotated[
        str | None,
        _option("--timeline", help="What the link does when: TOML, or a run's link.csv."),
    ],
    "fmi": Annotated[int | None, _option("--fmi", help="The FMU's FMI version, 2 or 3.")],
}
"""Scenario field → its command-line option."""


def on_scenario(command: Callable[..., None]) -> Callable[..., None]:
    """Give ``command(scenario, …)`` the SCENARIO argument and the options that override it."""
    own = list(inspect.signature(command).parameters.values())[1:]

    def wrapper(scenario: str, **options: Any) -> None:
        overrides = {field: options.pop(field) for field in OVERRIDES}
        given = {field: value for field, value in overrides.items() if value is not None}
        if names := given.pop("estimator", None):
            given |= {"estimator": names[0]} | ({"compare": names[1:]} if names[1:] else {})
        command(load(scenario, given), **options)

    parameters = [
        inspect.Parameter("scenario", inspect.Parameter.KEYWORD_ONLY, annotation=ScenarioArgument),
        *(
            inspect.Parameter(field, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=hint)
            for field, hint in OVERRIDES.items()
        ),
        *(parameter.replace(kind=inspect.Parameter.KEYWORD_ONLY) for parameter in own),
    ]
    wrapper.__name__ = command.__name__
    wrapper.__doc__ = command.__doc__
    wrapper.__annotations__ = {item.name: item.annotation for item in parameters}
    wrapper.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    return wrapper
