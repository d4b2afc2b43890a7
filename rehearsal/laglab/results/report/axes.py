"""The axes that plots share."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from bokeh.model import Model
from bokeh.models import DataRange1d


@dataclass
class Axes:
    """What the runs of a page share: an axis of time, and one of values for each kind of plot."""

    time: DataRange1d = field(default_factory=lambda: DataRange1d(range_padding=0.01))
    of: dict[str, DataRange1d] = field(default_factory=dict)

    def follow(self, curves: Sequence[Model]) -> None:
        """Time reaches as far as these do, too, whatever else is marked."""
        before = self.time.renderers
        self.time.renderers = [*(before if isinstance(before, list) else ()), *curves]

    def values(self, kind: str) -> DataRange1d:
        """The axis of all plots of this kind."""
        return self.of.setdefault(kind, DataRange1d(only_visible=True))
