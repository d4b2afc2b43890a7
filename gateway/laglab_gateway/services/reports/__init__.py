"""What the robot tells of itself, message by message."""

from laglab_gateway.services.reports.geography import SOMEWHERE, Origin
from laglab_gateway.services.reports.table import REPORTS, REQUESTS, Seen, report
from laglab_gateway.services.reports.telemetry import heartbeat

__all__ = ["REPORTS", "REQUESTS", "SOMEWHERE", "Origin", "Seen", "heartbeat", "report"]
