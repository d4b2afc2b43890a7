"""The robot's side of the link: a plant behind two delay lines, in lock-step with a station."""

from laglab_gateway.core import Gateway, GatewayConfig, Outcome
from laglab_gateway.delay import DelayLine
from laglab_gateway.errors import CommandError, GatewayError, StationSilentError, TraceError
from laglab_gateway.lockstep import Patience, serve
from laglab_gateway.plant import FmuPlant, Plant
from laglab_gateway.recorder import TLOG_FILE, TRACE_FILE, FileRecorder, NoRecorder, Recorder
from laglab_gateway.services import Parameter, Parameters, Services, standard_parameters
from laglab_gateway.trace import Trace, TraceRow, read_trace
from laglab_gateway.watch import Watch, Watcher

__all__ = [
    "TLOG_FILE",
    "TRACE_FILE",
    "CommandError",
    "DelayLine",
    "FileRecorder",
    "FmuPlant",
    "Gateway",
    "GatewayConfig",
    "GatewayError",
    "NoRecorder",
    "Outcome",
    "Parameter",
    "Parameters",
    "Patience",
    "Plant",
    "Recorder",
    "Services",
    "StationSilentError",
    "Trace",
    "TraceError",
    "TraceRow",
    "Watch",
    "Watcher",
    "read_trace",
    "serve",
    "standard_parameters",
]
