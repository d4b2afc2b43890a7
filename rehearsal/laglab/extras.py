"""What not every machine has installed: each side alone needs less than the whole rig."""

from enum import Enum
from importlib.util import find_spec

from laglab.errors import MissingExtraError


class Need(Enum):
    """What something needs: the extra that brings it, and the modules that are in it."""

    STEPPING = "gateway", ("fmpy",)
    DRAWING = "run", ("matplotlib",)
    REHEARSING = "run", ("fmpy", "matplotlib")
    MAPPING = "study", ("matplotlib", "pyarrow")
    STUDYING = "study", ("fmpy", "pyarrow", "pandas")
    SPREADING = "study", ("distributed",)
    PARQUET = "export", ("pyarrow",)
    MATLAB = "export", ("scipy",)
    BAGS = "export", ("mcap_ros2",)
    SEEING = "see", ("bokeh",)
    CAPTURES = "link", ("dpkt",)

    def __init__(self, extra: str, modules: tuple[str, ...]) -> None:
        self.extra = extra
        self.modules = modules


(
    STEPPING,
    DRAWING,
    REHEARSING,
    MAPPING,
    STUDYING,
    SPREADING,
    PARQUET,
    MATLAB,
    BAGS,
    SEEING,
    CAPTURES,
) = Need


def require(need: Need) -> None:
    """Raises MissingExtraError, with what to install, when something that is needed is missing."""
    for module in need.modules:
        if find_spec(module) is None:
            raise MissingExtraError(
                f"{module} is not installed here: pip install 'laglab[{need.extra}]' brings it "
                f"(in a clone of laglab, pip install '.[{need.extra}]')"
            )
