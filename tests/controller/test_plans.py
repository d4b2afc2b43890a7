"""What is planned with a command, and what of it is believed to be in force."""

import numpy as np
import pytest

from laglab_control import (
    Controller,
    Demand,
    Echo,
    Measured,
    PolarLaw,
    RobotModel,
    SpeedLimits,
    StationConfig,
)
from laglab_control.doubt import doubt
from laglab_control.flight import hear, send, sent_for, take_off
from laglab_control.model import Vector
from laglab_protocol import Command, Plan, Sender, Tick, frames_in
from laglab_station import Station

MODEL = RobotModel()
H = 8
START = (-0.5, -0.4, 0.2)


def controller(n: int = 2, plan: int = H, **config: object) -> Controller:
    return Controller(
        StationConfig(
            estimator="delayed-ekf",
            initial_estimate=START,
            command_delay=n,
            plan=plan,
            **config,  # type: ignore[arg-type]
        )
    )


def entries(k: int) -> list[Demand]:
    return [Demand(k + i / 100, 0.0) for i in range(H + 1)]


@pytest.mark.parametrize("limits", [SpeedLimits(), SpeedLimits(v_max=0.3, accel_max=2.0)])
def test_each_entry_is_what_would_be_commanded_then(limits: SpeedLimits) -> None:
    """A second controller, to which nothing comes, says tick by tick what the first one planned."""
    law = PolarLaw(goal_tolerance=0.45)
    planning = controller(law=law, limits=limits)
    planned = planning.answer(planning.start(), [])
    assert len(planned.plan) == H
    plain = controller(plan=0, law=law, limits=limits)
    control = plain.answer(plain.start(), [])
    assert control.drive == planned.drive
    for entry in planned.plan:
        control = plain.answer(plain.advance(control), [])
        assert control.drive.memory == entry.memory
        np.testing.assert_allclose(control.drive[:2], entry[:2], rtol=0, atol=1e-12)


class Clock:
    """A law whose speed is the time it is asked for."""

    def drive(self, pose: Vector, time: float, memory: object) -> Demand:
        return Demand(time, 0.0)


def test_each_entry_is_the_laws_at_the_time_when_it_comes_into_force() -> None:
    planning = controller(n=3, plan=5, law=Clock())
    control = planning.answer(planning.start(), [])
    assert [control.drive.v, *(entry.v for entry in control.plan)] == pytest.approx(
        [0.03, 0.04, 0.05, 0.06, 0.07, 0.08]
    )


def test_the_covariance_at_arrival_is_that_of_the_whole_way() -> None:
    """Linearised where each command comes into force, not where the robot is now."""
    flying = controller(n=30, plan=0)
    control = flying.answer(flying.start(), [])
    for _ in range(40):
        control = flying.answer(flying.advance(control), [])
    there = flying.at_arrival(control)
    x, P = control.pose, control.P
    for u in control.flight.in_flight:
        x, P = MODEL.predict(x, P, u)
    np.testing.assert_allclose(there.x, x, atol=1e-12)
    np.testing.assert_allclose(there.P, P, rtol=1e-12)


def test_a_plan_ends_where_the_robot_would_be_lost() -> None:
    law = PolarLaw(gamma=3e6)
    planning = controller(law=law)
    with np.errstate(all="ignore"):
        assert len(planning.answer(planning.start(), []).plan) < H


def test_over_a_tick_that_never_came_the_plan_goes_on_and_then_is_held() -> None:
    planning = controller()
    control = planning.answer(planning.start(), [])
    first = control
    for i in range(H + 3):
        control = planning.unanswered(control)
        assert control.drive == first.plan[min(i, H - 1)]
    without = controller(plan=0)
    control = without.answer(without.start(), [])
    assert without.unanswered(control) is control


def test_without_lateness_the_commands_themselves_are_believed_to_be_in_force() -> None:
    flight = take_off(MODEL, 2, H)
    for k in range(10):
        flight, applied = send(MODEL, flight, np.array((float(k), 0.0)), entries(k))
        assert applied[0] == max(k - 2, 0)


def test_where_commands_come_later_the_robot_is_further_on_in_older_plans() -> None:
    n, late = 2, 3
    flight = take_off(MODEL, n, H)
    for k in range(60):
        flight, _ = send(MODEL, flight, np.array((float(k), 0.0)), entries(k))
        if k >= n + late:
            made = k - n - late
            told = Echo(k, np.array((made + late / 100, 0.0)), made)
            flight, _ = hear(MODEL, flight, [told])
    assert (flight.command_delay, flight.usual_delay) == (n, n + late)
    for j in range(40, 60):
        assert sent_for(flight, j)[0] == pytest.approx(j - n - late + late / 100)
    # beyond the plan its last entry is held
    assert flight.plans is not None
    _, u = flight.plans.late(H + 5).send(entries(60))
    assert u[0] == 60 - (H + 5) + H / 100
    assert flight.plans.late(100).send(entries(60))[1].tolist() == [0.0, 0.0]


def test_a_robot_that_follows_sooner_than_told_is_believed() -> None:
    flight = take_off(MODEL, 6, H)
    for k in range(40):
        flight, _ = send(MODEL, flight, np.array((float(k), 0.0)), entries(k))
        if k >= 4:
            flight, _ = hear(MODEL, flight, [Echo(k, np.array((k - 4.0, 0.0)), k - 4)])
    assert (flight.command_delay, flight.usual_delay) == (4, 4)


def test_who_was_late_and_is_sooner_than_told_is_no_longer_late() -> None:
    flight = take_off(MODEL, 6, H)
    for k in range(20):
        flight, _ = send(MODEL, flight, np.array((float(k), 0.0)), entries(k))
    usual = []
    for tick, made in ((9, 0), (10, 6), (11, 7)):
        flight, _ = hear(MODEL, flight, [Echo(tick, np.array((float(made), 0.0)), made)])
        usual.append(flight.usual_delay)
    assert usual == [9, 9, 4]


@pytest.mark.parametrize(("silent", "doubted"), [(H, False), (H + 20, True)])
def test_as_long_as_plans_reach_silence_is_no_reason_to_doubt(silent: int, doubted: bool) -> None:
    flight = take_off(MODEL, 2, H)
    for k in range(40 + silent):
        flight, _ = send(MODEL, flight, np.array((0.1 + k / 50, 0.3)), entries(k))
        if 2 < k < 40:
            flight, _ = hear(MODEL, flight, [Echo(k, np.array((0.1, 0.3)), k - 2 - k % 2)])
    assert (doubt(flight, MODEL, np.zeros(3)) is not None) is doubted


def test_raw_plans_from_where_the_robot_was_seen() -> None:
    planning = Controller(StationConfig(estimator="raw", plan=3))
    assert planning.answer(planning.start(), []).plan == ()
    seen = planning.answer(planning.start(), [Measured(0, np.array(START))])
    assert len(seen.plan) == 3


def test_the_stations_plan_is_meant_for_the_tick_n_later() -> None:
    config = StationConfig(estimator="delayed-ekf", command_delay=5, plan=H)
    station, robot = Station(config), Sender(1, 1)
    for tick in (0, 1):
        answer = b"".join(station.hear(frames_in(robot.frame(Tick(tick, 0)))))
        *_, plan, command = (frame.message for frame in frames_in(answer))
        assert isinstance(plan, Plan)
        assert isinstance(command, Command)
        assert (plan.tick, plan.in_force, plan.first, command.plan) == (tick, tick + 5, 1, H)
