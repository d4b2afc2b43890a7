"""A figure that a notebook shows by itself."""

from io import BytesIO

from matplotlib.backend_bases import RendererBase
from matplotlib.figure import Figure
from matplotlib.text import Text


class Picture(Figure):
    """Made without pyplot, whose state is global; so it has to say by itself what it looks like."""

    def draw(self, renderer: RendererBase) -> None:
        """With the names that users gave as they wrote them, dollars too: the only formulas are the
        numbers along an axis of powers of ten."""
        axes = [each for panel in self.axes for each in (panel.xaxis, panel.yaxis)]
        powers = {text for each in axes if each.get_scale() == "log" for text in each.findobj(Text)}
        for text in self.findobj(Text):
            if isinstance(text, Text) and text not in powers:
                text.set_parse_math(False)
        super().draw(renderer)

    def _repr_png_(self) -> bytes:
        png = BytesIO()
        self.savefig(png, format="png")
        return png.getvalue()
