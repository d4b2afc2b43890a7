"""What a ground station expects of a rover: heartbeat, parameters, commands, telemetry."""

from laglab_gateway.services.asker import Asker, Askers
from laglab_gateway.services.pace import Pace
from laglab_gateway.services.parameters import (
    Parameter,
    ParameterTable,
    safety_now,
    standard_parameters,
)
from laglab_gateway.services.reports import Origin, heartbeat
from laglab_gateway.services.service import Services
from laglab_gateway.services.state import Arming, RobotState
from laglab_gateway.services.timesync import Timesyncing

__all__ = [
    "Arming",
    "Asker",
    "Askers",
    "Origin",
    "Pace",
    "Parameter",
    "ParameterTable",
    "RobotState",
    "Services",
    "Timesyncing",
    "heartbeat",
    "safety_now",
    "standard_parameters",
]
