"""MAV_RESULT: what became of a command."""

from laglab_protocol.dialect.generated import laglab as mavlink

ACCEPTED: int = mavlink.MAV_RESULT_ACCEPTED
REJECTED_FOR_NOW: int = mavlink.MAV_RESULT_TEMPORARILY_REJECTED
DENIED: int = mavlink.MAV_RESULT_DENIED
UNSUPPORTED: int = mavlink.MAV_RESULT_UNSUPPORTED
