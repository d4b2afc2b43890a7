"""The collector is held back for one loop, and no longer."""

import gc

from laglab.runs.pauses import short_pauses


def test_what_is_there_already_is_not_looked_through_again() -> None:
    usual, frozen = gc.get_threshold(), gc.get_freeze_count()
    with short_pauses():
        assert gc.get_freeze_count() > frozen + 10_000
        assert gc.get_threshold()[0] > usual[0]
    assert (gc.get_threshold(), gc.get_freeze_count()) == (usual, 0)


def test_new_cycles_are_still_collected() -> None:
    with short_pauses():
        before = gc.get_stats()[0]["collected"]
        for _ in range(50_000):
            cycle: list[object] = []
            cycle.append(cycle)
        assert gc.get_stats()[0]["collected"] > before + 10_000
