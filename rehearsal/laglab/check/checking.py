"""Each kind of thing through its checks."""

from collections.abc import Iterator, Mapping
from contextlib import ExitStack

from laglab.check import estimator, law, plant
from laglab.check.finding import Finding, findings
from laglab.check.subject import KINDS, SHIPPED, Kind, maker_of
from laglab.runs.plant import open_plant
from laglab.runs.plant.brought import PluginPlant
from laglab.scenario import Scenario, changed
from laglab_control import ESTIMATORS, Circle, ConfigError, Law, PolarLaw, find_plugin
from laglab_control.estimators import estimator_kind
from laglab_control.laws import brought_law, tracking_law

Options = Mapping[str, object]


def checked(kind: Kind, name: str, options: Options | None = None) -> Iterator[Finding]:
    """A row for each check, as they are done.

    Raises PluginError when there is no such thing; one that cannot be made fails its first row.
    """
    told = dict(options or {})
    if name not in SHIPPED[kind]:
        find_plugin(KINDS[kind], name, SHIPPED[kind])
    match kind:
        case "estimator":
            return _estimator(name, told)
        case "law":
            return findings(law.CHECKS, lambda: _law(name, told), _admits("law", name))
        case "plant":
            return _plants(name, told)


def _admits(kind: Kind, name: str) -> Mapping[str, str]:
    """The checks that do not hold by the word of its maker, each with why."""
    if kind == "estimator" and name in ESTIMATORS:
        return ESTIMATORS[name].admits
    if name in SHIPPED[kind]:
        return {}
    admits: Mapping[str, str] = getattr(maker_of(kind, name), "admits", {})
    return admits


def _estimator(name: str, options: dict[str, object]) -> Iterator[Finding]:
    of = estimator_kind(name, options)
    optimal = name == "delayed-ekf" or bool(
        name not in ESTIMATORS and getattr(maker_of("estimator", name), "optimal", False)
    )

    def make() -> estimator.Subject:
        return estimator.Subject(of.make(estimator.MODEL), optimal)

    return findings(estimator.CHECKS, make, _admits("estimator", name))


def _law(name: str, options: dict[str, object]) -> Law:
    if name == "polar":
        if options:
            raise ConfigError(f"law.options: polar has none, so leave {', '.join(options)} out")
        return PolarLaw(law.GOAL)
    if name == "tracking":
        return tracking_law(Circle(law.GOAL[:2], 1.0, 0.5), options)
    return brought_law(name, law.GOAL, options)


def _plants(name: str, options: dict[str, object]) -> Iterator[Finding]:
    with ExitStack() as opened:
        ours = name in SHIPPED["plant"]
        yield from findings(
            plant.CHECKS,
            lambda: _shipped(name, options, opened) if ours else _plant(name, options),
            _admits("plant", name),
        )


def _shipped(name: str, options: dict[str, object], opened: ExitStack) -> plant.Subject:
    """One of ours; however many are made, all are open until the last check is done."""
    table = "plant." if name == "robot" else "plant.parameters."
    scenario = changed(
        Scenario(name=name),
        {
            "plant.kind": name,
            "sample_time": plant.SAMPLE_TIME,
            "start": list(plant.START),
            "seed": plant.SEED,
            **{table + key: value for key, value in options.items()},
        },
    )
    return plant.Subject(lambda: opened.enter_context(open_plant(scenario)).plant)


def _plant(name: str, options: dict[str, object]) -> plant.Subject:
    told = plant.SAMPLE_TIME, plant.START, plant.SEED
    return plant.Subject(lambda: PluginPlant.made(name, *told, options))
