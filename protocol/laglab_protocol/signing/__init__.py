"""MAVLink 2 signatures: who may speak, and what was said already."""
