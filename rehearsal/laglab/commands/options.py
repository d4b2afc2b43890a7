"""The options that every command on a scenario shares: command line beats file."""

import inspect
from collections.abc import Callable
from typing import Annotated, Any

import typer

from laglab.scenario import assignment, load, read_timeline

ScenarioArgument = Annotated[
    str, typer.Argument(metavar="SCENARIO", help="A shipped scenario's name, or a TOML file.")
]


def _option(*names: str, help: str, metavar: str | None = None) -> Any:  # noqa: A002
    return typer.Option(*names, help=help, metavar=metavar, show_default=False)


POSE = "X,Y,THETA"
OPTIONS: dict[str, Any] = {
    "link.command_delay": Annotated[int | None, _option("-n", help="Command delay [ticks].")],
    "link.measurement_delay": Annotated[
        int | None, _option("-m", help="Measurement delay [ticks].")
    ],
    "start": Annotated[str | None, _option("--start", help="Start pose.", metavar=POSE)],
    "goal": Annotated[str | None, _option("--goal", help="Goal pose.", metavar=POSE)],
    "seed": Annotated[int | None, _option("--seed", help="Seed of every random draw.")],
    "noise": Annotated[
        bool | None, _option("--noise/--no-noise", help="Wheel and measurement noise.")
    ],
    "duration": Annotated[
        float | None, _option("--duration", help="Simulated time [s]; inf: until you end it.")
    ],
    "estimator.initial_covariance": Annotated[float | None, _option("--p0", help="P_0 = VALUE·I.")],
    "estimator.initial_estimate": Annotated[
        str | None, _option("--initial-estimate", help="x̂_0.", metavar=POSE)
    ],
    "law.v_max": Annotated[float | None, _option("--v-max", help="Speed limit [m/s].")],
    "law.omega_max": Annotated[float | None, _option("--omega-max", help="Turn limit [rad/s].")],
    "law.goal_tolerance": Annotated[
        float | None, _option("--goal-tolerance", help="Turn on the spot inside it [m].")
    ],
    "pace": Annotated[str | None, _option("--pace", help="lockstep, or realtime.")],
    "speed": Annotated[float | None, _option("--speed", help="Real time so many times as fast.")],
    "silence_timeout": Annotated[
        float | None, _option("--silence", help="Seconds until a silent side counts as gone.")
    ],
    "plant.fmi": Annotated[int | None, _option("--fmi", help="The FMU's FMI version, 2 or 3.")],
}
"""Dotted key of a scenario → its command-line option."""
OF_SEVERAL_KEYS: dict[str, Any] = {
    "estimator": Annotated[
        list[str] | None,
        _option("--estimator", help="The filter in the loop; further ones shadow it."),
    ],
    "timeline": Annotated[
        str | None,
        _option("--timeline", help="What the link does when: TOML, or a run's link.csv."),
    ],
    "set": Annotated[
        list[str] | None,
        _option(
            "--set",
            metavar="KEY=VALUE",
            help="Any key of a scenario, such as link.command.loss=0.1; again for more. "
            "It beats the file, and an option of its own beats it.",
        ),
    ],
}


def _overrides(options: dict[str, Any]) -> dict[str, object]:
    """What beats the file; takes the options out that say it."""
    own = {key: options.pop(_parameter(key)) for key in OPTIONS}
    own = {key: value for key, value in own.items() if value is not None}
    if names := options.pop("estimator"):
        own |= {"estimator.kind": names[0]}
        own |= {"estimator.compare": names[1:]} if names[1:] else {}
    if timeline := options.pop("timeline"):
        own |= read_timeline(timeline)
    told = dict(map(assignment, options.pop("set") or []))
    return {key: value for key, value in told.items() if key not in own} | own


def _parameter(key: str) -> str:
    return key.replace(".", "_")


def on_scenario(command: Callable[..., None]) -> Callable[..., None]:
    """Give ``command(scenario, …)`` the SCENARIO argument and the options that override it."""
    own = list(inspect.signature(command).parameters.values())[1:]

    def wrapper(scenario: str, **options: Any) -> None:
        overrides = _overrides(options)
        command(load(scenario, overrides, lambda text: typer.echo(text, err=True)), **options)

    hints = OF_SEVERAL_KEYS | {_parameter(key): hint for key, hint in OPTIONS.items()}
    parameters = [
        inspect.Parameter("scenario", inspect.Parameter.KEYWORD_ONLY, annotation=ScenarioArgument),
        *(
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=hint)
            for name, hint in hints.items()
        ),
        *(parameter.replace(kind=inspect.Parameter.KEYWORD_ONLY) for parameter in own),
    ]
    wrapper.__name__ = command.__name__
    wrapper.__doc__ = command.__doc__
    wrapper.__annotations__ = {item.name: item.annotation for item in parameters}
    wrapper.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    return wrapper
