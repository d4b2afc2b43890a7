"""Every block of code on every page does what it says, in the order of the page."""

from pathlib import Path

import pytest

from .page import blocks, do

ROOT = Path(__file__).parents[2]
PAGES = sorted(
    page
    for pattern in ("docs/**/*.md", "*/README.md", "examples/*/README.md")
    for page in ROOT.glob(pattern)
    if any(not block.not_run for block in blocks(page))
)


@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_the_page_works(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    do(page, tmp_path)
