"""Paths, and the law that follows them."""

import math

import numpy as np
import pytest

from laglab_control import Circle, ConfigError, Eight, RobotModel, TrackingLaw, Waypoints, wrap
from laglab_control.laws.paths import unwound

PATHS = [Circle((1.0, -2.0), 1.5, 0.5), Eight((0.5, 0.25), 3.0, 0.6)]


@pytest.mark.parametrize("path", PATHS, ids=lambda path: type(path).__name__)
def test_speeds_and_heading_are_those_of_the_points(path):
    times, step = np.linspace(0.0, 30.0, 200), 1e-5
    here = path.sampled(times)
    change = (path.sampled(times + step) - path.sampled(times - step)) / (2 * step)
    assert np.hypot(change[:, 0], change[:, 1]) == pytest.approx(here[:, 3], abs=1e-6)
    assert np.arctan2(change[:, 1], change[:, 0]) == pytest.approx(
        np.array([wrap(theta) for theta in here[:, 2]]), abs=1e-6
    )
    assert change[:, 2] == pytest.approx(here[:, 4], abs=1e-6)  # nor does theta ever jump
    assert path.at(7.0) == pytest.approx(path.sampled(np.array([7.0]))[0])


def test_how_large_and_how_fast_they_are():
    circle, eight = (path.sampled(np.linspace(0, 60, 20_001)) for path in PATHS)
    assert np.hypot(circle[:, 0] - 1, circle[:, 1] + 2) == pytest.approx(1.5)
    assert circle[0, :3] == pytest.approx([2.5, -2.0, math.pi / 2])
    assert np.ptp(eight[:, 0]) == pytest.approx(3.0, abs=1e-5)
    assert np.ptp(eight[:, 1]) == pytest.approx(1.5, abs=1e-5)
    assert eight[0] == pytest.approx([0.5, 0.25, math.pi / 4, 0.6, 0.0])
    assert eight[:, 3].max() == pytest.approx(0.6)


@pytest.mark.parametrize("path", PATHS, ids=lambda path: type(path).__name__)
def test_an_outline_leads_around_once_and_the_heading_never_jumps(path):
    outline = path.outline()
    steps = np.hypot(*np.diff(outline, axis=0).T)
    assert outline.shape[1] == 2
    assert outline[-1] == pytest.approx(outline[0])
    assert steps.max() < 0.05
    length = 2 * math.pi * 1.5 if isinstance(path, Circle) else 3.0 / 2 * 6.097
    assert steps.sum() == pytest.approx(length, rel=0.01)
    assert np.abs(np.diff(path.sampled(np.linspace(0.0, 60.0, 6001))[:, 2])).max() < 0.1


@pytest.mark.parametrize(
    ("beyond", "left"),
    [(0.0, 0.0), (1.0, 1.0), (math.tau, 0.0), (-2 * math.tau, 0.0), (math.tau - 1.5, -1.5)],
)
def test_a_jump_is_what_is_near_a_turn_from_where_the_speed_leads(beyond, left):
    times, omega = np.array([0.0, 2.0, 4.0]), np.array([1.0, 3.0, 0.0])
    theta = np.array([0.5, 4.5 + beyond, 7.5 + beyond])
    assert unwound(times, theta, omega) == pytest.approx([0.5, 4.5 + left, 7.5 + left])
    far = np.array([0.5, 4.5 + 3.0, 7.5 + 3.0])
    assert unwound(times, far, omega) == pytest.approx(far)


def test_between_the_rows_of_a_table_it_is_linear_and_outside_it_stands():
    path = Waypoints(
        np.array([1.0, 3.0, 4.0]),
        np.array([[0, 0, 0, 0.5, 0.1], [2, 1, 4, 1.5, 0.3], [2, 2, 5, 1.0, 0.2]], dtype=float),
    )
    assert path.at(2.0) == (1.0, 0.5, 2.0, 1.0, pytest.approx(0.2))
    assert path.at(4.0) == (2.0, 2.0, 5.0, 1.0, 0.2)
    assert path.at(9.0) == (2.0, 2.0, 5.0, 0.0, 0.0)
    assert path.at(1.0) == (0.0, 0.0, 0.0, 0.5, 0.1)
    assert path.outline().tolist() == [[0, 0], [2, 1], [2, 2]]
    assert path.at(0.0) == (0.0, 0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("least", [-math.pi, 0.0])
@pytest.mark.parametrize("turning", [1.0, 0.0])
def test_a_heading_that_jumps_by_a_turn_goes_on_without(least, turning):
    times = np.linspace(0.0, 30.0, 301)
    rows = PATHS[0].sampled(times) * [1, 1, 1, 1, turning]
    jumps = rows.copy()
    jumps[:, 2] = least + (rows[:, 2] - least) % (2 * np.pi)
    assert np.abs(np.diff(jumps[:, 2])).max() > 6
    between = times[:-1] + 0.05
    headings = [Waypoints(times, each).sampled(between)[:, 2] for each in (rows, jumps)]
    turns = (headings[1] - headings[0]) / (2 * np.pi)
    assert turns == pytest.approx(np.full(300, np.round(turns[0])), abs=1e-12)


def test_a_robot_may_turn_around_from_row_to_row():
    rows = np.array([[0, 0, 0, 0, 0.7], [0, 0, 7, 0, 0.7]], dtype=float)
    assert Waypoints(np.array([0.0, 10.0]), rows).at(5.0).theta == 3.5


@pytest.mark.parametrize(
    ("times", "rows", "said"),
    [
        ([0.0, 0.0], np.zeros((2, 5)), "must grow"),
        ([0.0, 1.0], np.zeros((2, 4)), "a row of x, y, theta, v, omega"),
        ([0.0, 1.0], np.full((2, 5), np.nan), "finite"),
        ([], np.zeros((0, 5)), "a row of"),
    ],
)
def test_what_is_no_path(times, rows, said):
    with pytest.raises(ConfigError, match=said):
        Waypoints(np.array(times), rows)


def test_kanayama_worked_by_hand():
    path = Waypoints(np.array([0.0, 1.0]), np.tile([1.0, 2.0, 0.5, 0.4, 0.2], (2, 1)))
    v, omega, memory = TrackingLaw(path).drive((0.0, 0.0, math.pi / 2), 0.5, None)
    # e_x = 2, e_y = -1, e_theta = 0.5 - pi/2
    turn = 0.5 - math.pi / 2
    assert v == pytest.approx(0.4 * math.cos(turn) + 2 * 2)
    assert omega == pytest.approx(0.2 + 0.4 * (16 * -1 + 8 * math.sin(turn)))
    assert memory is None


@pytest.mark.parametrize("path", PATHS, ids=lambda path: type(path).__name__)
def test_a_robot_beside_the_path_comes_onto_it_and_stays(path):
    law, robot = TrackingLaw(path), RobotModel()
    pose = np.array(path.at(0.0)[:3]) + np.array([0.2, -0.2, 0.3])
    for k in range(1500):
        v, omega, _ = law.drive(pose, k * 0.01, None)
        pose = robot.f(pose, np.array((v, omega)))
    assert pose[:2] == pytest.approx(path.at(15.0)[:2], abs=0.02)
