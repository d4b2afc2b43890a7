"""Runs: both sides made from a scenario, the way between them, in one process or in two."""
