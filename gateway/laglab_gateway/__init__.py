"""The robot's side of the link: a plant behind two delayed channels, paced by station or clock."""

from laglab_gateway.channel import Channel
from laglab_gateway.conversation import Link, Patience
from laglab_gateway.core import Gateway
from laglab_gateway.drive import Safety
from laglab_gateway.errors import (
    GatewayError,
    RobotSilentError,
    StationSilentError,
    TimelineError,
    TraceError,
)
from laglab_gateway.fates import Fates, RandomFates
from laglab_gateway.impairments import IDEAL, Burst, ExtraDelay, Impairments
from laglab_gateway.linklog import RecordedFates, read_link_log
from laglab_gateway.lockstep import serve_lockstep
from laglab_gateway.plant import FmuPlant, Plant
from laglab_gateway.realtime import Lateness, serve_realtime
from laglab_gateway.recorder import (
    LINK_FILE,
    TIMING_FILE,
    TLOG_FILE,
    TRACE_FILE,
    FileRecorder,
    NoRecorder,
    Recorder,
)
from laglab_gateway.relay import Relay
from laglab_gateway.remote import serve_remote
from laglab_gateway.services import (
    Parameter,
    Parameters,
    Services,
    Timesyncing,
    standard_parameters,
)
from laglab_gateway.side import GatewayConfig, Outcome, RobotSide
from laglab_gateway.timeline import Direction, Event
from laglab_gateway.trace import Trace, TraceRow, read_trace
from laglab_gateway.watch import Watch, Watcher

__all__ = [
    "IDEAL",
    "LINK_FILE",
    "TIMING_FILE",
    "TLOG_FILE",
    "TRACE_FILE",
    "Burst",
    "Channel",
    "Direction",
    "Event",
    "ExtraDelay",
    "Fates",
    "FileRecorder",
    "FmuPlant",
    "Gateway",
    "GatewayConfig",
    "GatewayError",
    "Impairments",
    "Lateness",
    "Link",
    "NoRecorder",
    "Outcome",
    "Parameter",
    "Parameters",
    "Patience",
    "Plant",
    "RandomFates",
    "RecordedFates",
    "Recorder",
    "Relay",
    "RobotSide",
    "RobotSilentError",
    "Safety",
    "Services",
    "StationSilentError",
    "TimelineError",
    "Timesyncing",
    "Trace",
    "TraceError",
    "TraceRow",
    "Watch",
    "Watcher",
    "read_link_log",
    "read_trace",
    "serve_lockstep",
    "serve_realtime",
    "serve_remote",
    "standard_parameters",
]
