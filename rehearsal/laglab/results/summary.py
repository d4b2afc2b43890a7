"""What a run tells of itself, as data: the contents of ``summary.json``."""

import os
from pathlib import Path
from typing import Literal

import msgspec
from msgspec import Struct

from laglab.errors import NoRunError
from laglab.files import json_of, write_whole
from laglab_gateway import TLOG_FILE, LinkReport, TimingReport
from laglab_station import StationReport

SUMMARY_FILE = "summary.json"
STUDY_FILE = "study.toml"
"""What a study's folder has instead."""
STUDY_CELLS = "cells"
"""The folder of the tables of a study's cells; of `laglab trust` there is no more."""
SCHEMA_VERSION = 4

Side = Literal["both", "robot", "station"]
Seen = Literal["true", "measured"]
"""Whether the robot's pose is known, or only as its sensor saw it."""


class Errors(Struct, frozen=True):
    """Errors of an estimate [m, m, rad]."""

    x: float
    y: float
    theta: float


class Following(Struct, frozen=True):
    """How far the robot was from where its path wanted it, over the second half of the run [m]."""

    rms: float
    largest: float


class Final(Struct, frozen=True):
    """The robot at the last tick: errors to the goal, or to where its path wanted it [m, rad], as
    measured those of the last second's mean; speeds in force [m/s, rad/s].

    None where nothing is known, or it is not finite.
    """

    rho: float | None
    theta_error: float | None
    v: float | None
    omega: float | None


class Summary(Struct, frozen=True, kw_only=True):
    """A run, in numbers. SI units; delays in ticks."""

    schema_version: int = SCHEMA_VERSION
    laglab: str
    """The version that made the run."""
    versions: dict[str, str] = {}
    """Of Python, numpy and FMPy, where it was made."""
    scenario: str
    side: Side
    """Who kept the record: both sides together, or one alone."""
    transport: str
    """What was between the sides."""
    plant: str
    """The robot's kind or its FMU's file, or the address of the real one; of a station alone,
    unknown."""
    estimator: str
    """Its kind; of a gateway alone, which does not know its station's, `the station's filter`."""
    law: str
    """Its kind; of a gateway alone, `unknown`."""
    n: int
    m: int
    seed: int
    ticks: int
    pose: Seen
    final: Final
    rms_error: Errors | None
    """Of the estimate over the ticks >= m; None where there was none."""
    compare: dict[str, Errors | None]
    """The same of the estimator in the loop and of those that shadowed it."""
    outcome: str | None
    """`completed`, `diverged`, `interrupted`, `failed`, `displaced`; None: it was cut short."""
    converged: bool
    """At the goal, or where its path wanted it, at every tick of the last second."""
    following: Following | None
    """None where there was no path."""
    wall_time_s: float
    real_time_factor: float | None
    link: LinkReport | None
    timing: TimingReport | None
    station: StationReport | None
    warnings: tuple[str, ...]
    verdict: str


def write_summary(summary: Summary, directory: Path) -> None:
    """Keep the summary beside the trace. Raises ResultsError."""
    write_whole(directory / SUMMARY_FILE, json_of(summary))


def read_summary(directory: Path) -> Summary:
    """The summary that a run left. Raises NoRunError: there is none, or of another version."""
    path = directory / SUMMARY_FILE
    try:
        data = path.read_bytes()
        version = msgspec.json.decode(data, type=_Versioned).schema_version
        if version == SCHEMA_VERSION:
            return msgspec.json.decode(data, type=Summary)
    except OSError as error:
        log = directory / TLOG_FILE
        if isinstance(error, FileNotFoundError) and log.exists():
            raise NoRunError(
                f"{directory} has no {SUMMARY_FILE}: that run was killed, had no tick, no room for "
                f"it, or is not over; its log can be replayed: laglab replay {log} --estimator NAME"
            ) from error
        raise NoRunError(_why_not(directory, error)) from error
    except (msgspec.DecodeError, RecursionError) as error:
        raise NoRunError(f"{path} is not a run's summary: {error}") from error
    except ValueError as error:  # a name with a 0 in it
        raise NoRunError(f"{str(directory)!r} is no name of a folder: {error}") from error
    raise NoRunError(f"{path} has schema version {version}, this laglab reads {SCHEMA_VERSION}")


def _why_not(directory: Path, error: OSError) -> str:
    there = os.path.exists(directory)  # noqa: PTH110 Path.exists raises where a name is too long
    if not (there or isinstance(error, PermissionError)):
        return f"{directory} is not there: name the folder of a run"
    if os.path.exists(directory / STUDY_FILE):  # noqa: PTH110 or where nobody may look
        return f"{directory} is a study's: `laglab map` and `laglab sweep --report` show it"
    return f"{directory / SUMMARY_FILE} cannot be read: {error.strerror}"


class _Versioned(Struct):
    schema_version: int = 1
