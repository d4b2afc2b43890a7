"""Rows as text: as if every number were written by its `repr`."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_gateway import csv_lines

Cell = int | float | str | None

numbers = st.floats() | st.integers(-(2**63), 2**63 - 1)
small = st.floats(-2e-4, 2e-4)
large = st.floats(1e15, 1e17)
words = st.sampled_from(["command", "not finite", "no", "", "drive2"])
rows = st.tuples(*[numbers | small | large | st.none(), small, large, words, numbers | st.none()])


def one_by_one(cells: tuple[Cell, ...]) -> str:
    return ",".join("" if c is None else c if isinstance(c, str) else repr(c) for c in cells) + "\n"


@given(table=st.lists(rows, max_size=5))
def test_it_is_what_repr_writes(table: list[tuple[Cell, ...]]) -> None:
    assert csv_lines(table).decode() == "".join(map(one_by_one, table))


@pytest.mark.parametrize("exponent", [-300, -6, -5, -4, -3, 0, 15, 16, 17, 300])
def test_it_is_what_repr_writes_of_many(exponent: int) -> None:
    cells = 10.0**exponent * np.random.default_rng(1).normal(size=(500, 8))
    table = [tuple(row) for row in cells.tolist()]
    assert csv_lines(table).decode() == "".join(map(one_by_one, table))


def test_what_only_looks_small_is_left_alone() -> None:
    numbers = (10.00001, -20.00003, 0.00001, -0.00001)
    assert csv_lines([numbers]) == b"10.00001,-20.00003,1e-05,-1e-05\n"
