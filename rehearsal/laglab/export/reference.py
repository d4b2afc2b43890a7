"""The reference page of the topics on which a run is told."""

from laglab.export.ros.definitions import DEFINITIONS
from laglab.export.ros.topics import TOPICS

INTRODUCTION = """\
# A run as ROS 2 messages

<!-- Generated from the topics: python docs/reference/generate.py -->

What [`laglab export`](../export.md) writes as `mcap` and `ros2bag`. SI units; times count from the
run's first tick, which is 1970-01-01. What is not known of a covariance is −1 in its first element;
of the speeds in an Odometry, which are those in force, nobody says how far they are off.

| topic | type | what it says |
|---|---|---|
"""


def page() -> str:
    """Markdown: a row a topic, and the definitions of our own messages."""
    rows = [f"| `{name}` | {kind} | {sentence} |\n" for name, kind, sentence in TOPICS]
    ours = [
        f"\n## `{name}`\n\n```\n{definition}\n```\n"
        for name, definition in DEFINITIONS.items()
        if name.startswith("laglab_msgs/")
    ]
    return "".join([INTRODUCTION, *rows, *ours])
