"""A page that follows a run while it runs, served by a process of its own. Needs bokeh.

The loop tells that process what its recorder is told, in datagrams that it does not wait for; a
browser gets them as server-sent events. Two orders go the other way: stop the robot, end the run.
"""

from laglab.live.feed import Controls, Feed, fed
from laglab.live.live import LivePage, live_page
from laglab.live.messages import Line
from laglab.live.onlooker import watched_station
from laglab.live.place import Place, place_of, spelled_out

__all__ = [
    "Controls",
    "Feed",
    "Line",
    "LivePage",
    "Place",
    "fed",
    "live_page",
    "place_of",
    "spelled_out",
    "watched_station",
]
