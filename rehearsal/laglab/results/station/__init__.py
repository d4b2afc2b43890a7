"""What a station alone knows of a run: from the frames that it heard and said."""

from laglab.results.station.glance import StationGlance
from laglab.results.station.heard import decoded, heard_ticks
from laglab.results.station.record import StationRecord, record_session

__all__ = ["StationGlance", "StationRecord", "decoded", "heard_ticks", "record_session"]
