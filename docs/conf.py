"""The site, made of the repository's own pages: sphinx-build -W -c docs . SITE"""

import re

from sphinx.application import Sphinx

from laglab import __version__

project = "laglab"
project_copyright = "the laglab developers"
release = version = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
root_doc = "docs/index"
exclude_patterns = [".*"]
include_patterns = ["docs/**.md", "*.md", "*/README.md", "examples/*/README.md"]
html_theme = "furo"
html_title = f"laglab {release}"
html_extra_path = ["site"]  # who opens the folder is led to the first page
html_copy_source = html_show_sourcelink = False

myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence"]

autodoc_typehints = "signature"
autodoc_member_order = "groupwise"
autodoc_default_options = {"members": True, "undoc-members": False, "show-inheritance": False}
autodoc_preserve_defaults = True
suppress_warnings = ["ref.python"]  # a message has a field `type`, and so has another
autodoc_use_type_comments = False


def _as_literal(*told: object) -> None:
    """Docstrings are prose with `code` in it: to reStructuredText their letters are markup."""
    lines = told[-1]
    assert isinstance(lines, list)
    parts = re.split(r"(`[^`\n]+`)", "\n".join(lines))
    for i, part in enumerate(parts):
        if part.startswith("`") and i % 2:
            parts[i] = f"`{part}`"
        else:
            parts[i] = re.sub(r"([*_|\\])", r"\\\1", part)
    lines[:] = "".join(parts).split("\n")


def setup(app: Sphinx) -> None:
    """What Sphinx calls."""
    app.connect("autodoc-process-docstring", _as_literal, priority=400)  # before napoleon
