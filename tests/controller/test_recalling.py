"""When the station asks what the robot did while nobody heard it."""

from laglab_control.flight import Told
from laglab_station.recalling import AGAIN, PATIENCE, Asked, Question, question


def told(known: int, *missing: int) -> Told:
    return Told()._replace(known=known, missing=missing)


def test_nothing_is_asked_where_nothing_is_missing() -> None:
    assert question(Asked(), told(100), 110) == (Asked(), None)


def test_what_may_still_come_by_itself_is_waited_for() -> None:
    late = told(100, 100 - PATIENCE + 1)
    assert question(Asked(), late, 110)[1] is None
    lost = told(101, 100 - PATIENCE + 1)
    assert question(Asked(), lost, 111)[1] == Question(96, 1)


def test_a_gap_is_asked_for_whole_and_only_once_at_a_time() -> None:
    gap = told(100, 50, 51, 52, 80)
    asked, first = question(Asked(), gap, 110)
    assert first == Question(50, 31)
    assert question(asked, gap, 111) == (asked, None)
    assert question(asked, gap, 110 + AGAIN)[1] == first


def test_a_new_gap_does_not_wait_for_the_answer_to_the_old_one() -> None:
    asked, _ = question(Asked(), told(100, 50), 110)
    _, second = question(asked, told(105, 50, 99), 115)
    assert second == Question(99, 1)
