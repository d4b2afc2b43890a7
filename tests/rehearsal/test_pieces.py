"""What is made of a run's tables is the same in however long pieces they are read."""

import numpy as np
import pytest

import laglab
from laglab.export.tables import _Beside
from laglab.results.columns import stride, thinned
from laglab.results.digest import followed
from laglab.results.meaning import Column
from laglab.results.numbers import AXES
from laglab.results.shadows import shadow_error
from laglab_gateway import Trace
from laglab_station import ShadowRow


def pieces_of(trace: Trace, length: int) -> list[Trace]:
    ticks = len(trace["tick"])
    return [
        {name: column[first : first + length] for name, column in trace.items()}
        for first in range(0, ticks, length)
    ]


def poses(trace: Trace) -> np.ndarray:
    return np.stack([trace[axis] for axis in AXES], axis=1)


@pytest.fixture(scope="module")
def circling() -> laglab.Run:
    told = {"law.kind": "tracking", "law.path": "circle(1.0, 0.3)", "duration": 5.0}
    return laglab.run("lab", told)


@pytest.mark.parametrize("length", [1000, 100, 77])
def test_a_path_is_judged_over_the_second_half(circling: laglab.Run, length: int) -> None:
    trace, target = circling.trace, circling.scenario.target
    ticks = trace["tick"]
    following = followed(pieces_of(trace, length), target, len(ticks))
    off = (poses(trace) - target.poses(ticks))[len(ticks) // 2 :]
    distance = np.hypot(off[:, 0], off[:, 1])
    assert following is not None
    assert following.rms == pytest.approx(np.sqrt(np.mean(distance**2)))
    assert following.largest == pytest.approx(distance.max())


@pytest.mark.parametrize("length", [1000, 30, 7])
def test_a_shadow_is_judged_from_tick_m_on(circling: laglab.Run, length: int) -> None:
    trace, rng, m = circling.trace, np.random.default_rng(1), 20
    rows = [ShadowRow(k, rng.normal(size=3), np.eye(3)) for k in range(len(trace["tick"]))]
    found = shadow_error(rows, pieces_of(trace, length), m)
    assert found is not None
    off = (np.array([row.x for row in rows]) - poses(trace))[m:, :2]
    assert (found.x, found.y) == pytest.approx(tuple(np.sqrt(np.mean(off**2, axis=0))))


@pytest.mark.parametrize(("of_trace", "of_other"), [(4, 10), (10, 4), (3, 5), (1, 10)])
def test_rows_of_two_tables_meet(of_trace: int, of_other: int) -> None:
    keys = np.arange(10.0)
    other = pieces_of({"tick": keys, "a": 2 * keys}, of_other)
    beside = _Beside(other, "tick", [Column("a", "m", "")])
    found = [beside.of(piece["tick"])["a"] for piece in pieces_of({"tick": keys}, of_trace)]
    np.testing.assert_array_equal(np.concatenate(found), 2 * keys)


@pytest.mark.parametrize("rows", [1, 99, 100, 101, 199, 200, 201, 1000])
def test_no_more_rows_are_drawn_than_may_be_and_not_many_fewer(rows: int) -> None:
    x, most = np.arange(rows), 100
    every = stride(rows, most)
    assert len(thinned({"x": x}, every)["x"]) <= most
    assert every == 1 or len(thinned({"x": x}, every - 1)["x"]) > most
