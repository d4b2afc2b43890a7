"""Which laglab this is."""

from functools import cache
from importlib.metadata import version


@cache
def laglab_version() -> str:
    """As installed; looked up once, for each look-up leaves something in memory."""
    return version("laglab")
