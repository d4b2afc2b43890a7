"""The remote station: messages in, messages out, and its loop."""

from laglab_control import StationConfig
from laglab_station.alarms import ESTIMATE_IS_WRONG
from laglab_station.driver import MakeController
from laglab_station.errors import RobotSilentError, StationError
from laglab_station.hearing import echoes, recalled
from laglab_station.loop import Onlooker, run_station
from laglab_station.recalling import Questions
from laglab_station.report import StationReport
from laglab_station.session import SessionTick, heard, read_session
from laglab_station.shadow import ShadowRow, shadow
from laglab_station.station import Station

__all__ = [
    "ESTIMATE_IS_WRONG",
    "MakeController",
    "Onlooker",
    "Questions",
    "RobotSilentError",
    "SessionTick",
    "ShadowRow",
    "Station",
    "StationConfig",
    "StationError",
    "StationReport",
    "echoes",
    "heard",
    "read_session",
    "recalled",
    "run_station",
    "shadow",
]
