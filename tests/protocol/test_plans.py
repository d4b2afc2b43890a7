"""A plan is put together from its frames, whole or not at all."""

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_protocol import LONGEST_PLAN, Assembly, Command, Message, Plan, Planned, Sender


def planned(tick: int, length: int) -> Planned:
    following = tuple((0.1 * i, -0.2 * i) for i in range(1, length + 1))
    return Planned(Command(5.0, 6.0, tick, 1, 1, 0, length), tick + 3, following)


def given_out(messages: list[Command | Plan]) -> list[Planned]:
    assembly = Assembly()
    return [whole for message in messages if (whole := assembly.take(message))]


@given(st.integers(1, LONGEST_PLAN), st.randoms(use_true_random=False))
def test_it_is_whole_with_its_last_frame_in_whatever_order(
    length: int, order: random.Random
) -> None:
    plan = planned(7, length)
    frames: list[Command | Plan] = [*plan.frames(), plan.command]
    assert len(frames) == 1 + (length + 14) // 15
    order.shuffle(frames)
    assert given_out(frames[:-1]) == []
    assert given_out(frames) == [plan]


def test_plans_of_several_ticks_do_not_mix_and_repeats_change_nothing() -> None:
    first, second = planned(7, 20), planned(8, 20)
    a, b = first.frames(), second.frames()
    mixed = [a[0], b[1], a[0], second.command, first.command, b[0], a[1]]
    assert given_out(mixed) == [second, first]


def test_what_lacks_a_frame_is_given_up_when_it_is_long_past() -> None:
    assembly = Assembly()
    lacking, later = planned(7, 20), planned(72, 5)
    assert assembly.take(lacking.frames()[1]) is None
    assert assembly.take(lacking.command) is None
    assert assembly.take_given_up() == []
    assert assembly.take(later.frames()[0]) is None
    assert assembly.take_given_up() == [lacking.command]
    assert assembly.take_given_up() == []


@pytest.mark.parametrize("first", [0, 2, 15, 256, 65535])
def test_a_frame_of_elements_that_are_none_is_passed_over(first: int) -> None:
    plan = planned(7, 15)
    (frame,) = plan.frames()
    odd = Plan(frame.v, frame.omega, 7, 10, first, 1, 1)
    assert given_out([odd, plan.command]) == []
    assert given_out([odd, plan.command, frame]) == [plan]


def test_a_plan_that_is_too_long_is_never_whole() -> None:
    frames = planned(7, LONGEST_PLAN).frames()
    assert given_out([*frames, Command(0.0, 0.0, 7, 1, 1, 0, LONGEST_PLAN + 1)]) == []


def test_a_command_without_a_plan_is_the_frame_that_it_always_was() -> None:
    """What it gained is left off while it is 0; a plan fits into one payload a frame."""

    def size(message: Message) -> int:
        return len(Sender(200, 190).frame(message)) - 12

    assert size(Command(0.5, 0.25, 9, 1, 1, 1)) == 23
    assert size(Command(0.5, 0.25, 9, 1, 1, 1, 15)) == 24
    assert size(planned(9, 15).frames()[0]) == 252
