"""A rosbag2 folder: the MCAP file, and what `ros2 bag` wants to know of it."""

from collections.abc import Iterator

from laglab.export.ros.mcap_file import Written, ros_name

VERSION = 5
"""Of the format: that of ROS 2 Humble, which later ones read."""


def metadata(written: Written, file: str) -> str:
    """The contents of metadata.yaml beside the MCAP file of this name."""
    return "\n".join(_lines(written, file)) + "\n"


def _lines(written: Written, file: str) -> Iterator[str]:
    messages, first, last = written
    yield "rosbag2_bagfile_information:"
    yield f"  version: {VERSION}"
    yield "  storage_identifier: mcap"
    yield f"  relative_file_paths: [{file}]"
    yield f"  duration: {{nanoseconds: {last - first}}}"
    yield f"  starting_time: {{nanoseconds_since_epoch: {first}}}"
    yield f"  message_count: {messages.total()}"
    yield "  topics_with_message_count:"
    for topic, count in messages.items():
        yield "    - topic_metadata:"
        yield f"        name: {topic.name}"
        yield f"        type: {ros_name(topic.type)}"
        yield "        serialization_format: cdr"
        yield '        offered_qos_profiles: ""'
        yield f"      message_count: {count}"
    yield '  compression_format: ""'
    yield '  compression_mode: ""'
    yield "  files:"
    yield f"    - path: {file}"
    yield f"      starting_time: {{nanoseconds_since_epoch: {first}}}"
    yield f"      duration: {{nanoseconds: {last - first}}}"
    yield f"      message_count: {messages.total()}"
