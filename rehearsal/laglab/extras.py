"""What not every machine has installed: each side alone needs less than the whole rig."""

from importlib.util import find_spec

from laglab.errors import MissingExtraError

STEPPING = "gateway"
"""The extra that brings FMPy, which steps the robot."""
REHEARSING = "run"
"""The extra that brings all of it, matplotlib too."""

MODULES = {STEPPING: ("fmpy",), REHEARSING: ("fmpy", "matplotlib")}


def require(extra: str) -> None:
    """Raises MissingExtraError, with what to install, when something of the extra is missing."""
    for module in MODULES[extra]:
        if find_spec(module) is None:
            raise MissingExtraError(
                f"{module} is not installed here: install laglab with the extra {extra!r}, "
                f"as in pip install '.[{extra}]'"
            )
