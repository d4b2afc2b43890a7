"""A figure that a notebook shows by itself."""

from io import BytesIO

from matplotlib.backend_bases import RendererBase
from matplotlib.figure import Figure
from matplotlib.text import Text

from laglab.results.figures.settings import drawn, plain


class Picture(Figure):
    """Made without pyplot, whose state is global; so it has to say by itself what it looks like."""

    def draw(self, renderer: RendererBase) -> None:
        """With the names that users gave as they wrote them, dollars too: the only formulas are the
        numbers along an axis of powers of ten."""
        with drawn():  # what matplotlib adds while it draws, such as numbers along an axis
            self._write_names()
            super().draw(renderer)

    def _write_names(self) -> None:
        axes = [each for panel in self.axes for each in (panel.xaxis, panel.yaxis)]
        powers = {text for each in axes if each.get_scale() == "log" for text in each.findobj(Text)}
        for text in self.findobj(Text):
            if isinstance(text, Text) and text not in powers:
                text.set_parse_math(False)

    def _repr_png_(self) -> bytes:
        png = BytesIO()
        with plain():
            self.savefig(png, format="png")
        return png.getvalue()
