"""What the two sides were told, compared."""

import pytest
from msgspec.structs import replace

from laglab_protocol import (
    Parties,
    Settings,
    SettingsError,
    differences,
    refuse_other_sample_time,
)

TOLD = Settings(0.01, 0.05, 0.6, 1.0, 1.7, 10, 20)


@pytest.mark.parametrize(
    ("field", "robots", "stations", "said"),
    [
        ("command_playout", 15, 0, "play-out of commands: 15 ticks for the robot, 0 ticks for"),
        ("measurement_playout", 30, 25, "play-out of measurements: 30 ticks for the robot, 25"),
        ("plan", 0, 20, "plan: 0 ticks for the robot, 20 ticks for the controller"),
        ("plan", 65535, 20, ""),
        ("measurement_playout", 65535, 25, ""),
        ("command_playout", 15, 15, ""),
    ],
)
def test_play_out_and_plan_are_compared_where_both_are_known(
    field: str, robots: int, stations: int, said: str
) -> None:
    robot, station = (replace(TOLD, **{field: value}) for value in (robots, stations))
    found = differences(robot, station)
    assert found.startswith(said)
    assert bool(found) == bool(said)


def test_who_was_told_another_pace_is_named() -> None:
    parties = Parties("the robot at udpout://x", "this gateway", "say --set sample_time=0.01")
    with pytest.raises(SettingsError) as told:
        refuse_other_sample_time(Settings(0.01), Settings(0.02), parties)
    assert str(told.value) == (
        "the sample time is 0.01 s for the robot at udpout://x and 0.02 s for this gateway: say "
        "--set sample_time=0.01"
    )
