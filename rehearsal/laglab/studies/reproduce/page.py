"""The report as one HTML page, with its pictures in it."""

from base64 import b64encode
from collections.abc import Sequence
from html import escape

from laglab.studies.reproduce.entry import TITLE, Entry, opening

STYLE = """
:root { color-scheme: light dark; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; }
th, td { text-align: left; padding: 0.2rem 0.8rem 0.2rem 0; border-bottom: 1px solid #8886; }
section { border-top: 1px solid #8886; margin-top: 2rem; }
code { background: #8882; padding: 0.1rem 0.3rem; }
img { max-width: 100%; background: white; }
.where { opacity: 0.7; }
"""


def page(of: Sequence[Entry]) -> str:
    """Whole: it needs neither a network nor another file."""
    rows = "\n".join(map(_row, of))
    sections = "\n".join(map(_section, of))
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{TITLE}</title>
<style>{STYLE}</style>
</head>
<body>
<h1>{TITLE}</h1>
<p>{escape(opening(of))}</p>
<table>
<tr><th>claim</th><th>where</th><th>verdict</th></tr>
{rows}
</table>
{sections}
</body>
</html>
"""


def _row(entry: Entry) -> str:
    name, place = escape(entry.claim.name), escape(entry.claim.place)
    verdict = f"{entry.sign} {escape(entry.spelled)}"
    return f'<tr><td><a href="#{name}">{name}</a></td><td>{place}</td><td>{verdict}</td></tr>'


def _section(entry: Entry) -> str:
    claim = entry.claim
    picture = ""
    if entry.picture:
        data = b64encode(entry.picture).decode()
        picture = f'<p><img alt="{escape(claim.name)}" src="data:image/png;base64,{data}"></p>'
    return f"""<section id="{escape(claim.name)}">
<h2>{escape(claim.name)} <small class="where">{escape(claim.place)}</small></h2>
<p><em>The paper:</em> {_code(claim.says)}</p>
<p><em>Here:</em> {_code(entry.got)}</p>
<p><strong>{entry.sign} {escape(entry.spelled)}.</strong> {_code(entry.claim.why)}</p>
<p>{_code(f"`{claim.command}`")}</p>
{picture}
</section>"""


def _code(text: str) -> str:
    """With what is in backticks as code."""
    parts = escape(text).split("`")
    return "".join(f"<code>{part}</code>" if i % 2 else part for i, part in enumerate(parts))
