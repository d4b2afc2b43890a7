from collections import deque
from operator import add

import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_controller.log import append, newest_first
from laglab_controller.sliding import SlidingProduct

pushes_and_pops = st.lists(st.one_of(st.text("abc", max_size=2), st.none()))


@given(pushes_and_pops)
def test_the_product_is_that_of_the_items_in_order(steps):
    """Text and + make a product that shows the order of its factors."""
    window, expected = SlidingProduct[str, str](add, ""), deque[str]()
    for step in steps:
        if step is not None:
            window = window.push(step, step)
            expected.append(step)
        elif expected:
            item, window = window.pop()
            assert item == expected.popleft()
        assert window.product == "".join(expected)
        assert list(window) == list(expected)


def test_an_empty_window_gives_no_item():
    with pytest.raises(IndexError):
        SlidingProduct[str, str](add, "").pop()


@given(st.integers(0, 50), st.integers(1, 10))
def test_a_log_keeps_at_least_its_limit_and_at_most_twice(count, limit):
    log = None
    for item in range(count):
        log = append(log, item, limit)
    kept = list(newest_first(log))
    assert kept == list(range(count))[::-1][: len(kept)]
    assert min(count, limit) <= len(kept) <= 2 * limit
    assert log is None or log.length == len(kept)
