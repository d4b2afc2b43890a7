"""What the sides of a run can say about themselves in one line."""

from laglab_control import ControlError, PluginFailedError
from laglab_fmu import FmuError
from laglab_gateway import GatewayError, PlantSilentError, PlantWaitsError, StationSilentError
from laglab_protocol import FarEndGoneError, FarEndStalledError, ProtocolError
from laglab_station import RobotSilentError, StationError

SIDE_ERRORS = (FmuError, GatewayError, ControlError, StationError, ProtocolError)

CUT_SHORT = (
    StationSilentError,
    RobotSilentError,
    PlantSilentError,
    PlantWaitsError,
    FarEndGoneError,
    FarEndStalledError,
    PluginFailedError,
)
"""What ends a run that had begun; the other errors of a side are the user's to mend."""
