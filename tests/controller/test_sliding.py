"""The product over a sliding window, and the log under it: right, bounded, never changed."""

from collections import deque
from operator import add

import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_control.past.log import append, cut, logged, newest_first
from laglab_control.past.sliding import SlidingProduct

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
    log = logged()
    for item in range(count):
        log = append(log, item, limit)
        assert log.newest == item
    kept = list(newest_first(log))
    assert kept == list(range(count))[::-1][: len(kept)]
    assert min(count, limit) <= len(kept) <= 2 * limit
    assert log.length == len(kept)


@given(st.lists(st.tuples(st.integers(0, 100), st.integers(0, 9)), max_size=30))
def test_no_version_of_a_log_ever_changes(steps):
    """Each step goes on from some earlier version, as a tree of runs would."""
    versions = [(logged(), [])]
    for which, item in steps:
        log, expected = versions[which % len(versions)]
        versions.append((append(log, item, limit=100), [*expected, item]))
    for log, expected in versions:
        assert list(newest_first(log))[::-1] == expected
        older, newer = cut(log, len(expected) // 2)
        assert list(newest_first(older))[::-1] + newer == expected


def test_an_empty_log_has_no_newest():
    with pytest.raises(IndexError):
        _ = logged().newest


def test_what_goes_on_from_a_log_that_was_cut_leaves_out_what_came_since():
    log = logged(1, 2, 3)
    older, _ = cut(log, 2)
    assert list(newest_first(append(older, 9, limit=100))) == [9, 2, 1]
    assert list(newest_first(log)) == [3, 2, 1]


def test_one_more_costs_no_copy():
    log = logged(1, 2)
    assert append(log, 3, limit=100).items is log.items
