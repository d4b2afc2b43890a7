"""What not every machine has installed: each side alone needs less than the whole rig."""

import sys
from importlib.util import find_spec
from typing import NamedTuple

from laglab.errors import MissingExtraError


class Need(NamedTuple):
    """What something needs: the extra that brings it, and the modules that are in it."""

    extra: str
    modules: tuple[str, ...]


STEPPING = Need("gateway", ("fmpy",))
DRAWING = Need("run", ("matplotlib",))
REHEARSING = Need("run", ("fmpy", "matplotlib"))
MAPPING = Need("study", ("matplotlib", "pyarrow"))
FRAMES = Need("study", ("pandas",))
STUDYING = Need("study", ("fmpy", "pyarrow", "pandas"))
SPREADING = Need("study", ("distributed",))
PARQUET = Need("export", ("pyarrow",))
MATLAB = Need("export", ("scipy",))
BAGS = Need("export", ("mcap_ros2",))
SEEING = Need("see", ("bokeh",))
CAPTURES = Need("link", ("dpkt",))


def require(need: Need) -> None:
    """Raises MissingExtraError, with what to install, when something that is needed is missing."""
    for module in need.modules:
        if find_spec(module) is None:
            raise MissingExtraError(
                f"{module} is not installed here: pip install 'laglab[{need.extra}]' brings it "
                f"(in a clone of laglab, pip install '.[{need.extra}]')" + _by_another_pip()
            )


def _by_another_pip() -> str:
    """How to install into an environment that has no pip: what is called so is another's."""
    return "" if find_spec("pip") else f"; here is no pip: take pip --python {sys.executable}"
