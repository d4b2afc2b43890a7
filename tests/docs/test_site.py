"""The pages as a site: built without a warning, every page in it, every one reached."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_the_site_is_built_without_a_warning(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-c", "docs", "."]
    done = subprocess.run(
        [*command, tmp_path / "site", "-d", tmp_path / "trees"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    for page in ROOT.glob("docs/**/*.md"):
        assert (tmp_path / "site" / page.relative_to(ROOT)).with_suffix(".html").exists()
    front = (tmp_path / "site" / "index.html").read_text("utf-8")
    assert 'url=docs/index.html"' in front
    api = (tmp_path / "site" / "docs" / "reference" / "python.html").read_text("utf-8")
    assert 'id="laglab.run"' in api
    assert 'id="laglab_control.DelayedEkf"' in api


def test_every_page_has_its_place() -> None:
    """Sphinx says which is in no table of contents; this says it without building."""
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    named = {
        line
        for block in re.findall(r"```{toctree}\n(.*?)```", index, re.S)
        for line in block.split()
    }
    for page in ROOT.glob("docs/**/*.md"):
        place = str(page.relative_to(ROOT / "docs").with_suffix(""))
        assert place in named | {"index"}, place
