"""How long the past is kept."""

MEMORY = 1024
"""Ticks: what comes later than that changes nothing. The robot recalls as many."""
