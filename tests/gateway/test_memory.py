"""What the robot remembers of the speeds that were in force."""

import math

from laglab_gateway.memory import APPLIED_A_TICK, KEPT, MOST_OWED, Owed, SpeedMemory
from laglab_protocol import RECALLED, Applied, Recall


def remembering(ticks: int) -> SpeedMemory:
    memory = SpeedMemory()
    for tick in range(ticks):
        memory.keep(tick, (float(tick), -float(tick)))
    return memory


def asked(first: int, count: int) -> Recall:
    return Recall(first, count, 1, 1)


def told(answers: list[Applied]) -> dict[int, tuple[float, float]]:
    return {
        answer.first + i: (answer.v[i], answer.omega[i])
        for answer in answers
        for i in range(answer.count)
    }


def test_it_tells_what_was_in_force_in_as_many_answers_as_it_takes() -> None:
    answers = list(remembering(100).answers(asked(30, RECALLED + 3)))
    assert [(each.first, each.count) for each in answers] == [(30, RECALLED), (30 + RECALLED, 3)]
    assert told(answers) == {tick: (tick, -tick) for tick in range(30, 30 + RECALLED + 3)}


def test_what_it_does_not_know_is_told_as_not_known() -> None:
    (answer,) = remembering(5).answers(asked(3, 4))
    assert answer.v[:2] == (3.0, 4.0)
    assert all(map(math.isnan, answer.v[2:4]))
    assert list(remembering(5).answers(asked(5, 100))) == []


def test_the_oldest_are_forgotten() -> None:
    memory = remembering(KEPT + 10)
    assert not memory.lacks(asked(10, KEPT))
    assert memory.lacks(asked(9, 1))


def test_a_question_for_everything_is_answered_in_bounds() -> None:
    assert len(list(remembering(10).answers(asked(0, 65535)))) == 1
    memory = remembering(3 * KEPT)
    answers = list(memory.answers(asked(2 * KEPT, 65535)))
    assert len(answers) <= KEPT // RECALLED + 1
    answers = list(memory.answers(asked(2 * KEPT - 100, 65535)))
    assert max(each.first + each.count for each in answers) == 3 * KEPT - 100


def test_what_is_owed_has_a_bound() -> None:
    owed = Owed()
    owed.owe(Applied((0.0,) * 12, (0.0,) * 12, first, 1) for first in range(1000))
    told = [len(owed.take()) for _ in range(1000)]
    assert max(told) == APPLIED_A_TICK
    assert sum(told) == MOST_OWED


def test_it_learns_from_a_robot_of_its_own_memory_but_never_what_is_not_finite() -> None:
    robot, relay = remembering(8), SpeedMemory()
    for answer in robot.answers(asked(4, 8)):
        relay.learn(answer)
    assert told(list(relay.answers(asked(4, 4)))) == {tick: (tick, -tick) for tick in range(4, 8)}
    assert relay.lacks(asked(8, 1))


def test_ticks_that_begin_again_begin_with_nothing() -> None:
    memory = remembering(10)
    memory.forget()
    assert list(memory.answers(asked(0, 10))) == []
