"""The messages as an MCAP file, in CDR, with their definitions."""

import math
from collections import Counter
from collections.abc import Iterable
from typing import BinaryIO, NamedTuple

from mcap.records import Schema
from mcap_ros2.writer import Writer

from laglab.export.ros.definitions import whole_definition
from laglab.export.ros.stream import Said, said
from laglab.export.ros.topics import Topic
from laglab.results.run import SCENARIO_FILE, Run

EPOCH = "the run's first tick"


class Written(NamedTuple):
    """What is in the file: messages by topic, and the times of the first and the last [ns]."""

    messages: Counter[Topic]
    first: int
    last: int


def write_mcap(run: Run, file: BinaryIO) -> Written:
    """Every message of the run, and its scenario as an attachment. Raises NoRunError.

    The same run gives the same bytes: no time of day is in them.
    """
    writer = Writer(file)
    writer.add_metadata("laglab", {"version": run.summary.laglab, "epoch": EPOCH})
    scenario = run.scenario.to_toml().encode()
    writer.add_attachment(0, 0, SCENARIO_FILE, "application/toml", scenario)
    written = _write_all(writer, said(run))
    writer.finish()  # type: ignore[no-untyped-call]
    return written


def _write_all(writer: Writer, messages: Iterable[Said]) -> Written:
    schemas: dict[str, Schema] = {}
    counts, first, last = Counter[Topic](), math.inf, 0
    for logged, topic, message, made in messages:
        kind = topic.type
        if kind not in schemas:
            schemas[kind] = writer.register_msgdef(ros_name(kind), whole_definition(kind))
        writer.write_message(topic.name, schemas[kind], message, logged, made, counts[topic])
        counts[topic] += 1
        first, last = min(first, logged), max(last, logged)
    return Written(counts, int(min(first, last)), last)


def ros_name(kind: str) -> str:
    """As ROS 2 names the type of a message."""
    return kind.replace("/", "/msg/")
