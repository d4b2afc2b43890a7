"""Scenarios: nested tables, what beats them, and what they share with the parts."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from pydantic import ValidationError

import laglab
from laglab.errors import ScenarioError
from laglab.runs.robot_side import gateway_config
from laglab.runs.station_side import station_config
from laglab.scenario import Scenario, assignment, changed, load, shipped
from laglab.scenario.keys import ANY, rows
from laglab_control import ConfigError, PolarLaw, RobotModel, SpeedLimits, StationConfig
from laglab_gateway import Impairments, Safety

SHARED: list[tuple[str, Callable[..., object], str]] = [
    ("sample_time", RobotModel, "sample_time"),
    ("plant.wheel_radius", RobotModel, "wheel_radius"),
    ("plant.track", RobotModel, "track"),
    ("law.gamma", PolarLaw, "gamma"),
    ("law.lambda", PolarLaw, "lambda_"),
    ("law.h", PolarLaw, "h"),
    ("law.v_max", SpeedLimits, "v_max"),
    ("law.omega_max", SpeedLimits, "omega_max"),
    ("law.goal_tolerance", PolarLaw, "goal_tolerance"),
    ("link.command_delay", StationConfig, "command_delay"),
    ("link.command.loss", Impairments, "loss"),
    ("safety.ramp", Safety, "ramp"),
]


@pytest.mark.parametrize("value", [-1, -1e-9, 0, 1e-9, 1, 1.5, 7.0, math.nan, math.inf, "1", True])
@pytest.mark.parametrize(("key", "made", "field"), SHARED)
def test_a_file_and_a_program_may_say_the_same(
    key: str, made: Callable[..., object], field: str, value: object
) -> None:
    def refused(refusal: type[Exception], make: Callable[[], object]) -> bool:
        try:
            make()
        except refusal:
            return True
        return False

    told = {key: value, "duration": 10.0 if key != "sample_time" else math.inf}
    by_file = refused(ScenarioError, lambda: load("fig6", told))
    assert by_file == refused(ValueError, lambda: made(**{field: value}))


def test_defaults_are_those_of_the_paper_and_of_the_parts() -> None:
    scenario = Scenario()
    assert (scenario.law.gamma, scenario.law.lambda_, scenario.law.h) == (3.0, 6.0, 1.0)
    model = station_config(scenario).model
    assert (model.Q == RobotModel().Q).all()
    assert (model.R == RobotModel().R).all()


def test_nothing_can_be_changed_or_added() -> None:
    with pytest.raises(ValidationError):
        load("fig6").law.gamma = 1.0
    with pytest.raises(ValidationError):
        Scenario(colour="red")  # type: ignore[call-arg]


OVERRIDES = {
    "link.command_delay": 3,
    "link.command.burst.good_to_bad": 0.1,
    "link.event": [{"at": 2.0}],
    "law.lambda": 5.0,
    "start": "1,2,3",
    "plant.integration": "exact",
}


def test_dotted_keys_reach_into_the_tables() -> None:
    scenario = load("lab-radio", OVERRIDES)
    assert (scenario.link.command_delay, scenario.link.measurement_delay) == (3, 20)
    assert scenario.link.command.burst is not None
    assert scenario.link.command.burst.good_to_bad == 0.1
    assert scenario.link.command.loss == 0.05
    assert [event.at for event in scenario.link.event] == [2.0]
    assert scenario.link.event[0].duration == math.inf
    assert (scenario.law.lambda_, scenario.start) == (5.0, (1.0, 2.0, 3.0))
    assert changed(load("lab-radio"), OVERRIDES) == scenario


def test_the_robot_moves_as_its_integration_says() -> None:
    euler, exact = (
        laglab.run("fig6", {"duration": 1.0, "plant.integration": way}).trace
        for way in ("euler", "exact")
    )
    difference = np.hypot(euler["x"][-1] - exact["x"][-1], euler["y"][-1] - exact["y"][-1])
    assert 1e-4 < difference < 0.1


def test_the_tables_of_a_list_are_counted() -> None:
    event = load("lab-radio", {"link.event.0.link.loss": 0.5}).link.event[0]
    assert (event.at, event.link.loss) == (3.0, 0.5)
    with pytest.raises(ScenarioError, match=r"link\.event\.1: must be the number of an element"):
        load("lab-radio", {"link.event.1.at": 0.5})


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("law.v_max=1.5", 1.5),
        ("law.v_max = 1.5", 1.5),
        ("law.v_max=inf", math.inf),
        ("law.v_max=true", True),
        ("law.v_max=popf", "popf"),
        ('law.v_max="popf"', "popf"),
        ("law.v_max=delayed-ekf", "delayed-ekf"),
        ("law.v_max=1,2,3", "1,2,3"),
        ("law.v_max=runs/a b/link.csv", "runs/a b/link.csv"),
        ("law.v_max=[1, 2]", [1, 2]),
        ("law.v_max={ a = 1 }", {"a": 1}),
        ("law.v_max=1\nseed=2", "1\nseed=2"),
        ("law.v_max=a=b", "a=b"),
    ],
)
def test_an_assignment_is_a_toml_value_or_a_word(text: str, value: object) -> None:
    assert assignment(text) == ("law.v_max", value)


@pytest.mark.parametrize(
    "text", ["", "seed", "=1", "a..b=1", "seed=", "start=[1", "seed='1", ".a=1"]
)
def test_what_is_no_assignment(text: str) -> None:
    with pytest.raises(ScenarioError, match=r"^--set "):
        assignment(text)


def test_every_key_can_be_set() -> None:
    for place, key, _ in rows():
        if ANY not in place:
            allowed = load("fig6", {place: key.default} if key.default is not None else {})
            assert allowed.last_tick == 1000


def test_a_duration_without_end_has_no_last_tick() -> None:
    endless = load("fig6", {"duration": math.inf})
    assert endless.last_tick is None
    assert gateway_config(endless).last_tick is None
    with pytest.raises(ScenarioError, match="duration: must be finite here, not inf"):
        laglab.run(endless)


def test_the_distance_from_start_to_goal_is_what_counts() -> None:
    far = {"goal": "5000,5000,0", "start": "4998,4999,0"}
    assert load("fig6", far).first_estimate().tolist() == [4998.0, 4999.0, 0.0]
    with pytest.raises(ScenarioError, match=r"fig6: start: must be within 1000 m of the goal, not"):
        load("fig6", {"goal": "5000,5000,0"})
    with pytest.raises(ScenarioError, match=r"estimator\.initial_estimate: must be within 1000 m"):
        load("fig6", {"estimator.initial_estimate": "900,500,0"})
    with pytest.raises(ScenarioError, match=r"estimator\.initial_estimate: must be within 1000 m"):
        load("lab", {"estimator.initial_covariance": 1e12})
    with pytest.raises(ConfigError):
        StationConfig(goal=(5000.0, 5000.0, 0.0))


def test_all_that_ship_are_short_and_whole() -> None:
    scenarios = shipped()
    assert list(scenarios) == [
        "fig4",
        "fig5",
        "fig6",
        "fig7",
        "fig8",
        "lab",
        "lab-radio",
        "lab-real",
        "track-circle",
        "track-eight",
    ]
    assert all(scenario.description for scenario in scenarios.values())
