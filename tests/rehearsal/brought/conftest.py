"""A folder with what somebody brought, in which the commands are run."""

import shutil
from pathlib import Path

import pytest


@pytest.fixture
def brought(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """With `mine` and `broken` in it; the current directory."""
    for name in ("mine.py", "broken.py"):
        shutil.copy(Path(__file__).with_name(name), tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path
