"""The robot's side of the link: a plant, or a real robot, behind two channels that delay."""

from laglab_gateway.config import GatewayConfig
from laglab_gateway.core import Gateway
from laglab_gateway.drive import Safety
from laglab_gateway.errors import (
    ConfigError,
    GatewayError,
    PlantSilentError,
    PlantWaitsError,
    StationSilentError,
    TimelineError,
    TraceError,
    UnplaceableError,
)
from laglab_gateway.link.channel import Channel
from laglab_gateway.link.fates import LONGEST_EXTRA, FateKind, Fates, RandomFates
from laglab_gateway.link.impairments import IDEAL, Burst, ExtraDelay, Impairments
from laglab_gateway.link.log import (
    MOST_TICKS,
    LinkRow,
    RecordedFates,
    read_link_log,
    recorded_ticks,
)
from laglab_gateway.link.timeline import DIRECTIONS, Direction, Event, first_tick
from laglab_gateway.loops.lockstep import serve_lockstep
from laglab_gateway.loops.realtime import serve_realtime
from laglab_gateway.loops.remote import serve_remote
from laglab_gateway.loops.surroundings import Patience, Served, Surroundings, served
from laglab_gateway.loops.watch import Watch, Watcher
from laglab_gateway.outcome import Outcome
from laglab_gateway.plant import Plant, Reading
from laglab_gateway.record.audit import ClockReport, DelayReport, DirectionReport, LinkReport
from laglab_gateway.record.files import (
    ARRIVALS_FILE,
    CLAIMS_FILE,
    LINK_FILE,
    ROWS,
    TIMING_FILE,
    TLOG_FILE,
    TRACE_FILE,
    FileRecorder,
    Row,
)
from laglab_gateway.record.lateness import TimingReport
from laglab_gateway.record.recorder import MemoryRecorder, Recorder, Tapped
from laglab_gateway.record.rows import FOLLOWED, ArrivalRow, ClaimRow, TimingRow, claimed
from laglab_gateway.record.text import csv_header, csv_lines, in_pieces, whole_lines
from laglab_gateway.record.trace import (
    Trace,
    TraceRow,
    read_trace,
    trace_of,
    trace_pieces,
)
from laglab_gateway.relay import Relay
from laglab_gateway.services import (
    Origin,
    Parameter,
    ParameterTable,
    Services,
    Timesyncing,
    standard_parameters,
)
from laglab_gateway.side import RobotSide

__all__ = [
    "ARRIVALS_FILE",
    "CLAIMS_FILE",
    "DIRECTIONS",
    "FOLLOWED",
    "IDEAL",
    "LINK_FILE",
    "LONGEST_EXTRA",
    "MOST_TICKS",
    "ROWS",
    "TIMING_FILE",
    "TLOG_FILE",
    "TRACE_FILE",
    "ArrivalRow",
    "Burst",
    "Channel",
    "ClaimRow",
    "ClockReport",
    "ConfigError",
    "DelayReport",
    "Direction",
    "DirectionReport",
    "Event",
    "ExtraDelay",
    "FateKind",
    "Fates",
    "FileRecorder",
    "Gateway",
    "GatewayConfig",
    "GatewayError",
    "Impairments",
    "LinkReport",
    "LinkRow",
    "MemoryRecorder",
    "Origin",
    "Outcome",
    "Parameter",
    "ParameterTable",
    "Patience",
    "Plant",
    "PlantSilentError",
    "PlantWaitsError",
    "RandomFates",
    "Reading",
    "RecordedFates",
    "Recorder",
    "Relay",
    "RobotSide",
    "Row",
    "Safety",
    "Served",
    "Services",
    "StationSilentError",
    "Surroundings",
    "Tapped",
    "TimelineError",
    "Timesyncing",
    "TimingReport",
    "TimingRow",
    "Trace",
    "TraceError",
    "TraceRow",
    "UnplaceableError",
    "Watch",
    "Watcher",
    "claimed",
    "csv_header",
    "csv_lines",
    "first_tick",
    "in_pieces",
    "read_link_log",
    "read_trace",
    "recorded_ticks",
    "serve_lockstep",
    "serve_realtime",
    "serve_remote",
    "served",
    "standard_parameters",
    "trace_of",
    "trace_pieces",
    "whole_lines",
]
