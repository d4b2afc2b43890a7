"""What somebody's FMU is told before it starts: arrays, and values of each type."""

import math
from pathlib import Path

import pytest
from fmpy.model_description import ModelVariable

from laglab import load, run
from laglab_fmu import FmuFileError, WiringError
from laglab_fmu.foreign import FmuFile, ForeignRobot, Wiring, check
from laglab_fmu.foreign.start_values import parameter_values, starts
from laglab_fmu.foreign.wiring import Value

TS = 0.01
INPUTS = {"v": "twist[0]", "omega": "twist[1]"}
POSE = {"x": "pose[0]", "y": "pose[1]", "theta": "pose[2]"}
MAP = {f"plant.inputs.{ours}": theirs for ours, theirs in INPUTS.items()} | {
    f"plant.outputs.{ours}": theirs for ours, theirs in POSE.items()
}


def after_a_tick(fmus: Path, parameters: dict[str, Value]) -> tuple[float, ...]:
    """Where the sled is, told 1 m/s and 0.5 rad/s."""
    with ForeignRobot(
        FmuFile.read(fmus / "Sled.fmu"), Wiring(INPUTS, POSE, {}, parameters), TS
    ) as robot:
        return robot.step((1.0, 0.5))


@pytest.mark.parametrize(
    ("parameters", "speed"),
    [
        ({}, 1.0),
        ({"gear": (2, 1)}, 2.0),
        ({"gear": "2 1"}, 2.0),
        ({"gear[0]": 2.0}, 2.0),
        ({"gear": [3, 1], "gear[0]": 2}, 2.0),
        ({"on": [False, True, True]}, 0.0),
        ({"on": "false true true"}, 0.0),
        ({"on[0]": 0}, 0.0),
    ],
)
def test_an_array_is_told_whole_or_by_its_elements(
    fmus: Path, parameters: dict[str, Value], speed: float
) -> None:
    assert after_a_tick(fmus, parameters) == pytest.approx((speed * TS, 0.0, 0.5 * TS))


@pytest.mark.parametrize("parameters", [{"twist": [0.0, 0.0, 2.0]}, {"twist[2]": 2.0}])
def test_what_a_command_leaves_of_an_array_stays_as_it_was_told(
    fmus: Path, parameters: dict[str, Value]
) -> None:
    assert after_a_tick(fmus, parameters) == pytest.approx((3.0 * TS, 0.0, 0.5 * TS))


def test_what_the_start_leaves_of_an_array_stays_as_it_was_told(fmus: Path) -> None:
    wiring = Wiring(INPUTS, POSE, {"x": "start[0]"}, {"start": [9.0, 2.0, 3.0]})
    with ForeignRobot(FmuFile.read(fmus / "Sled.fmu"), wiring, TS, (1.0,)) as robot:
        assert robot.outputs == (1.0, 2.0, 3.0)
        robot.restart((4.0,))
        assert robot.outputs == (4.0, 2.0, 3.0)


def test_a_scenario_s_lists_reach_the_fmu(fmus: Path) -> None:
    told = {"plant.parameters.gear": [2, 1], "plant.parameters.on": [True, False, True]}
    scenario = load("fig6", {"plant.fmu": str(fmus / "Sled.fmu"), **MAP, **told, "duration": 0.5})
    trace = run(scenario, transport="inline").trace
    x, y = trace["x"], trace["y"]
    assert not trace["theta"].any()
    assert math.hypot(x[-1] - x[-2], y[-1] - y[-2]) == pytest.approx(2 * TS * abs(trace["v"][-2]))


@pytest.mark.parametrize(
    ("parameters", "said"),
    [
        ({"size": 4}, "size of Sled.fmu is a structural parameter, .* stays at 3"),
        ({"gear": [300000000000, 1]}, "gear of Sled.fmu takes a whole number from -2147483648 to"),
        ({"gear[0]": 1.5}, r"gear\[0\] of Sled.fmu takes a whole number .*, not 1.5"),
        ({"on[0]": 0.5}, r"on\[0\] of Sled.fmu takes true or false, not 0.5"),
        ({"start": "1 x 3"}, "start of Sled.fmu takes a number, not 'x'"),
        ({"start": 2.0}, r"start of Sled.fmu has 3 elements: give a list of 3, not 2.0, or start"),
        ({"start": [1.0, 2.0]}, r"start of Sled.fmu has 3 elements: give a list of 3, not \[1.0"),
        ({"start[3]": 1.0}, "has 3 elements, counted from 0"),
    ],
)
def test_what_no_variable_can_have_is_refused_before_it_runs(
    fmus: Path, parameters: dict[str, Value], said: str
) -> None:
    with pytest.raises(WiringError, match=f"^parameters: .*{said}"):
        check(FmuFile.read(fmus / "Sled.fmu"), Wiring(INPUTS, POSE, {}, parameters), TS)


def test_an_element_by_two_names_is_one(fmus: Path) -> None:
    wiring = Wiring(INPUTS, {**POSE, "y": "pose[ 0]"})
    with pytest.raises(WiringError, match=r"outputs.y: pose\[ 0\] is outputs.x already"):
        check(FmuFile.read(fmus / "Sled.fmu"), wiring, TS)


def test_an_array_without_elements_is_no_number(fmus: Path) -> None:
    file = FmuFile.read(fmus / "Sled.fmu")
    file.variables["pose"].shape = (0,)
    with pytest.raises(WiringError, match=r"outputs.x: pose of Sled.fmu is an array without elem"):
        check(file, Wiring(INPUTS, {**POSE, "x": "pose"}), TS)


def test_a_text_of_an_array_is_not_told_by_itself(fmus: Path) -> None:
    file = FmuFile.read(fmus / "Sled.fmu")
    (gear,) = (each for each in file.description.modelVariables if each.name == "gear")
    gear.type, gear.start = "String", None
    wiring = Wiring(INPUTS, POSE, {}, {"gear[0]": "low"})
    with pytest.raises(WiringError, match=r"gear\[0\] of Sled.fmu is no number: tell gear whole"):
        check(file, wiring, TS)
    assert parameter_values(file, Wiring(INPUTS, POSE, {}, {"gear": "low 1"})) == {
        "gear": ["low", "1"]
    }


def test_one_start_value_is_that_of_all_elements() -> None:
    def variable(start: str | None, *shape: int) -> ModelVariable:
        return ModelVariable("pose", 1, start=start, shape=shape)

    assert starts(variable("2.5", 2, 2)) == [2.5] * 4
    assert starts(variable("1 2", 2)) == [1.0, 2.0]
    assert starts(variable(None, 2)) == [0.0, 0.0]
    with pytest.raises(FmuFileError, match="pose starts at '1 x', which is no number"):
        starts(variable("1 x", 2))
