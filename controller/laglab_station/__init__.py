"""The remote station: messages in, messages out, and its loop."""

from laglab_control import StationConfig
from laglab_station.errors import RobotSilentError, StationError
from laglab_station.loop import run_station
from laglab_station.report import StationReport, TickTimes
from laglab_station.session import Heard, read_session
from laglab_station.shadow import Shadow, shadow
from laglab_station.station import Station

__all__ = [
    "Heard",
    "RobotSilentError",
    "Shadow",
    "Station",
    "StationConfig",
    "StationError",
    "StationReport",
    "TickTimes",
    "read_session",
    "run_station",
    "shadow",
]
