"""What the two sides were told, side by side, when they meet."""

import math
from typing import NamedTuple

from laglab_protocol.errors import SettingsError
from laglab_protocol.messages.loop import UNKNOWN_DELAY, Settings

TELLS_WITHIN = 1.0
"""[s] Of its first tick a robot may still say what it was told: on a stream all comes in pieces."""


class Setting(NamedTuple):
    """One field of LAGLAB_SETTINGS, for people."""

    field: str
    spelled: str
    unit: str = ""
    limit: bool = False
    """It may be lower for the station: then the robot is never asked for more than it can do."""


SETTINGS = (
    Setting("dialect", "dialect version"),
    Setting("wheel_radius", "wheel radius", " m"),
    Setting("track", "track", " m"),
    Setting("v_max", "speed limit", " m/s", limit=True),
    Setting("omega_max", "turn limit", " rad/s", limit=True),
    Setting("command_delay", "n", " ticks"),
    Setting("measurement_delay", "m", " ticks"),
    Setting("command_playout", "play-out of commands", " ticks"),
    Setting("measurement_playout", "play-out of measurements", " ticks"),
    Setting("plan", "plan", " ticks"),
)


class Parties(NamedTuple):
    """Who was told what, and what to do where that is not the same pace."""

    one: str = "the robot"
    other: str = "the controller"
    advice: str = "give both sides the same scenario"


TWO_SIDES = Parties()


def refuse_other_sample_time(
    robot: Settings, station: Settings, parties: Parties = TWO_SIDES
) -> None:
    """Raises SettingsError when the two do not tick at the same pace."""
    told = robot.sample_time, station.sample_time
    if all(map(math.isfinite, told)) and told[0] != told[1]:
        raise SettingsError(
            f"the sample time is {told[0]:g} s for {parties.one} and {told[1]:g} s for "
            f"{parties.other}: {parties.advice}"
        )


def differences(robot: Settings, station: Settings, parties: Parties = TWO_SIDES) -> str:
    """What the two were told differently besides, in one line; empty when there is nothing."""
    found = (_difference(setting, robot, station, parties) for setting in SETTINGS)
    return "; ".join(filter(None, found))


def _difference(setting: Setting, robot: Settings, station: Settings, parties: Parties) -> str:
    theirs, ours = getattr(robot, setting.field), getattr(station, setting.field)
    same = ours <= theirs if setting.limit else ours == theirs
    if same or not (_is_known(theirs) and _is_known(ours)):
        return ""
    robots, stations = (_spelled(value, setting) for value in (theirs, ours))
    return f"{setting.spelled}: {robots} for {parties.one}, {stations} for {parties.other}"


def _is_known(value: float) -> bool:
    return not math.isnan(value) and value != UNKNOWN_DELAY


def _spelled(value: float, setting: Setting) -> str:
    return "none" if math.isinf(value) else f"{value:g}{setting.unit}"
