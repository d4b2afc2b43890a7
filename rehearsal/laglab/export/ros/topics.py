"""The topics on which a run is told, and what each is for."""

from typing import NamedTuple


class Topic(NamedTuple):
    """Its name, the type of its messages as `package/Message`, and what they say."""

    name: str
    type: str
    sentence: str

    def below(self, word: str) -> "Topic":
        """One of several topics of this kind, named below it."""
        return self._replace(name=f"{self.name}/{word}")


TRUE = Topic(
    "/laglab/true",
    "nav_msgs/Odometry",
    "Where the robot is, of the frame `robot`; absent of a real robot. The covariance is 0.",
)
ESTIMATE = Topic(
    "/laglab/estimate",
    "nav_msgs/Odometry",
    "Where the filter in the loop says that it is, of the frame `robot_estimate`, "
    "with the covariance that it claims.",
)
SHADOW = Topic(
    "/laglab/shadow",
    "nav_msgs/Odometry",
    "The same of each filter that shadowed the loop, below its name, of the frame `robot_NAME`.",
)
MEASUREMENT = Topic(
    "/laglab/measurement",
    "geometry_msgs/PoseStamped",
    "What was measured: stamped when it was sampled, logged when it had come across the link; "
    "what was lost is not there.",
)
SENT = Topic(
    "/laglab/command_sent",
    "geometry_msgs/TwistStamped",
    "The speeds that the station commanded, when it did.",
)
APPLIED = Topic(
    "/laglab/command_applied",
    "geometry_msgs/TwistStamped",
    "The speeds in force, from then on.",
)
LINK = Topic(
    "/laglab/link",
    "laglab_msgs/LinkEvent",
    "Below it `command` and `measurement`: what an impaired link did to each frame, when it "
    "entered.",
)
ARRIVAL = Topic(
    "/laglab/arrival",
    "laglab_msgs/Arrival",
    "Below it `command` and `measurement`: what came out of the link, when, and how late.",
)
TRANSFORMS = Topic(
    "/tf",
    "tf2_msgs/TFMessage",
    "The same poses, from `world` to each of these frames.",
)

TOPICS = (TRUE, ESTIMATE, SHADOW, MEASUREMENT, SENT, APPLIED, LINK, ARRIVAL, TRANSFORMS)
