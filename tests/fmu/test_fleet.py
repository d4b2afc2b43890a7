"""A fleet is its robots, bit for bit."""

from collections.abc import Callable
from ctypes import POINTER, c_double
from typing import Any

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException

from laglab_fmu import OUTPUTS, CallError, Fleet, OtherParameters, Robot, RobotParameters, fmu_path
from laglab_fmu.foreign import FmuFile, ForeignRobot, Wiring
from laglab_fmu.models import ROBOT

ROBOTS = [
    RobotParameters(seed=3 * i, start=(0.1 * i, -1.0, i), wheel_slip=0.01 * i) for i in range(7)
]
TICKS = 60


def speeds(tick: int) -> np.ndarray:
    """(robots, 2), row-major."""
    return np.column_stack([np.cos(np.arange(7) + tick), np.arange(7.0)])


def test_robot_i_equals_a_single_robot_bit_for_bit() -> None:
    with Fleet.open(ROBOTS) as fleet:
        history = [fleet.readings.copy()]
        history += [fleet.step(speeds(tick)).copy() for tick in range(TICKS)]
    for i, parameters in enumerate(ROBOTS):
        with Robot.open(3, parameters) as robot:
            assert tuple(history[0][i]) == robot.read()
            for tick in range(TICKS):
                assert tuple(history[tick + 1][i]) == robot.step(*speeds(tick)[i])


OTHERS = {
    "Car": {"steering_time_constant": 0.2, "integration": 2},
    "Omni": {"first_wheel_error": -0.01, "motor_time_constant": 0.05, "noise": True},
}


@pytest.mark.parametrize("model", OTHERS)
def test_so_are_those_of_the_others(model: str) -> None:
    own = [{**OTHERS[model], "seed": 3 * i, "theta_start": 0.5 * i} for i in range(7)]
    with Fleet.open([OtherParameters(model, each) for each in own]) as fleet:
        history = [fleet.readings.copy()]
        history += [fleet.step(speeds(tick)).copy() for tick in range(TICKS)]
    inputs = {"v": "v_command", "omega": "omega_command"}
    file = FmuFile.read(fmu_path(3, model))
    for i, parameters in enumerate(own):
        wiring = Wiring(inputs, {name: name for name in OUTPUTS}, parameters=parameters)
        with ForeignRobot(file, wiring, 0.01) as robot:
            assert tuple(history[0][i]) == robot.outputs
            for tick in range(TICKS):
                assert tuple(history[tick + 1][i]) == robot.step(speeds(tick)[i].tolist())


def test_a_fleet_is_of_one_model_with_parameters_that_it_has() -> None:
    car = OtherParameters("Car", {})
    assert car.sample_time == 0.01
    with pytest.raises(ValueError, match="2 robots are of 2 models, not of one"):
        Fleet.open([car, OtherParameters("Omni", {})])
    with pytest.raises(ValueError, match="Plane is none of Robot, Car, Omni"):
        Fleet.open([OtherParameters("Plane", {})])
    with pytest.raises(CallError, match="Car has no parameter track"):
        Fleet.open([OtherParameters("Car", {"track": 0.3})])
    with pytest.raises(CallError, match="wheelbase = 'long' refused: it is no number"):
        Fleet.open([OtherParameters("Car", {"wheelbase": "long"})])
    with pytest.raises(CallError, match=r"integration = 1.5 refused: it is no whole number"):
        Fleet.open([OtherParameters("Car", {"integration": 1.5})])
    for unfit in ({"seed": 2**32 + 5}, {"wheelbase": 10**400}):
        with pytest.raises(CallError, match="or too large"):
            Fleet.open([OtherParameters("Car", unfit)])
    with pytest.raises(CallError, match="wheelbase = -1 refused"):
        Fleet.open([OtherParameters("Car", {"wheelbase": -1.0})])
    with Fleet.open([car]) as fleet, pytest.raises(ValueError, match="Omni for a fleet of Car"):
        fleet.reset([OtherParameters("Omni", {})])


def test_nothing_is_copied() -> None:
    with Fleet.open(ROBOTS) as fleet:
        assert fleet.readings.shape == (7, 8)
        mine = np.asfortranarray(speeds(0))
        given = fleet.step(mine)
        assert given is fleet.readings
        assert fleet.inputs.value == mine.ctypes.data
        assert fleet.outputs.value == given.ctypes.data
        as_columns = given.copy()
        fleet.reset(ROBOTS)
        assert (fleet.step(speeds(0)) == as_columns).all()


def test_mistakes_are_named() -> None:
    with pytest.raises(ValueError, match="0 robots"):
        Fleet.open([])
    with pytest.raises(ValueError, match="2 sample times"):
        Fleet.open([RobotParameters(), RobotParameters(sample_time=0.02)])
    with pytest.raises(CallError, match=r"robots = .* refused"):
        Fleet.open([RobotParameters()] * 1_000_001)
    with pytest.raises(CallError, match="track = 0 refused"):
        Fleet.open([RobotParameters(), RobotParameters(track=0.0)])
    with Fleet.open(ROBOTS) as fleet:
        with pytest.raises(ValueError, match=r"\(3, 2\), not \(7, 2\)"):
            fleet.step(np.zeros((3, 2)))
        before = fleet.readings.copy()
        with pytest.raises(CallError, match=r"tick 0: .*omega_right = nan"):
            fleet.step(np.where(np.arange(14).reshape(7, 2) == 9, np.nan, 1.0))
        fleet.fetch()
        assert (fleet.readings == before).all()
        with pytest.raises(ValueError, match="1 robots for a fleet of 7"):
            fleet.reset(ROBOTS[:1])


def test_the_size_is_set_in_configuration_mode_only(make_face: Callable[..., Any]) -> None:
    face = make_face("Fleet3", "CoSimulation")
    with pytest.raises(FMICallException):
        face.set(robots=3)
    assert "configuration mode" in face.messages[-1][2]
    face.fmu.enterConfigurationMode()
    with pytest.raises(FMICallException):
        face.set(robots=0)
    assert "robots = 0 refused" in face.messages[-1][2]
    face.set(robots=3)
    face.fmu.exitConfigurationMode()
    assert face.fmu.getUInt64([ROBOT.reference["robots"]]) == [3]
    assert face.fmu.getInt32([ROBOT.reference["seed"]], 3) == [1, 2, 3]
    with pytest.raises(FMICallException):
        face.fmu.getFloat64([ROBOT.reference["x"]], 2)
    assert "2 values given for variables that hold 3" in face.messages[-1][2]


def test_reset_gives_the_size_its_default_back(make_face: Callable[..., Any]) -> None:
    face = make_face("Fleet3", "CoSimulation")
    face.fmu.enterConfigurationMode()
    face.set(robots=3)
    face.fmu.exitConfigurationMode()
    face.fmu.reset()
    assert face.fmu.getUInt64([ROBOT.reference["robots"]]) == [1]
    assert face.fmu.getInt32([ROBOT.reference["seed"]]) == [1]
    face.start()
    face.step(0.0)


def test_in_model_exchange_robot_i_equals_a_single_robot(make_face: Callable[..., Any]) -> None:
    """Three robots with sample times of their own, by Euler steps of 0.01 s."""
    sample_times, outputs = [0.01, 0.02, 0.03], ("x", "theta", "x_meas", "v")
    fleet = make_face("Fleet3", "ModelExchange")
    fleet.fmu.enterConfigurationMode()
    fleet.set(robots=3)
    fleet.fmu.exitConfigurationMode()
    fleet.fmu.setFloat64([ROBOT.reference["sample_time"]], sample_times)
    together = integrate(fleet, 3, outputs)
    for i, sample_time in enumerate(sample_times):
        robot = make_face("Robot3", "ModelExchange")
        robot.set(sample_time=sample_time, seed=i + 1)
        assert (together[:, :, i] == integrate(robot, 1, outputs)[:, :, 0]).all()


def integrate(face: Any, robots: int, outputs: tuple[str, ...]) -> np.ndarray:
    """Twenty Euler steps; (steps, outputs, robots)."""
    fmu, readings = face.fmu, []
    states, slopes = np.zeros(3 * robots), np.zeros(3 * robots)
    face.start()
    fmu.setFloat64([ROBOT.reference["omega_right"]], [4.0] * robots)
    *_, next_event = fmu.updateDiscreteStates()
    fmu.enterContinuousTimeMode()
    for step in range(1, 21):
        fmu.getContinuousStates(pointer(states), len(states))
        fmu.getContinuousStateDerivatives(pointer(slopes), len(slopes))
        states += 0.01 * slopes
        fmu.setTime(step * 0.01)
        fmu.setContinuousStates(pointer(states), len(states))
        if next_event < step * 0.01 + 1e-9:
            fmu.enterEventMode()
            *_, next_event = fmu.updateDiscreteStates()
            fmu.enterContinuousTimeMode()
        references = [ROBOT.reference[name] for name in outputs]
        readings.append(fmu.getFloat64(references, len(outputs) * robots))
    return np.array(readings).reshape(20, len(outputs), robots)


def pointer(array: np.ndarray) -> Any:
    return array.ctypes.data_as(POINTER(c_double))


def test_derivatives_and_states_of_a_fleet(make_face: Callable[..., Any]) -> None:
    face = make_face("Fleet3", "CoSimulation")
    face.fmu.enterConfigurationMode()
    face.set(robots=2)
    face.fmu.exitConfigurationMode()
    face.fmu.setFloat64([ROBOT.reference["theta_start"]], [0.0, np.pi / 2])
    face.fmu.setBoolean([ROBOT.reference["noise"]], [False, False])
    face.fmu.enterInitializationMode()
    face.fmu.exitInitializationMode()
    face.fmu.setFloat64(
        [ROBOT.reference["omega_left"], ROBOT.reference["omega_right"]], [2.0, 4.0, 2.0, 4.0]
    )
    unknowns = [ROBOT.reference["der(x)"], ROBOT.reference["der(y)"]]
    v = [0.1, 0.2]
    given = face.fmu.getDirectionalDerivative(unknowns, [ROBOT.reference["theta"]], [1.0, 1.0], 4)
    np.testing.assert_allclose(given, [0.0, -v[1], v[0], 0.0], atol=1e-16)
    state = face.save()
    data = face.serialize(state)
    face.step(0.0)
    moved = face.fmu.getFloat64([ROBOT.reference["x"], ROBOT.reference["y"]], 4)
    face.restore(state)
    face.free(state)
    face.step(0.0)
    assert face.fmu.getFloat64([ROBOT.reference["x"], ROBOT.reference["y"]], 4) == moved
    alone = make_face("Fleet3", "CoSimulation")
    received = alone.deserialize(data)
    with pytest.raises(FMICallException):
        alone.restore(received)
    assert "of 2 robot(s)" in alone.messages[-1][2]
    alone.free(received)
