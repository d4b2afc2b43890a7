"""A folder with what somebody brought, in which the commands are run."""

import shutil
import sys
from pathlib import Path

import pytest


@pytest.fixture
def brought(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """With `mine` and `broken` in it; the current directory."""
    for name in ("mine.py", "broken.py"):
        shutil.copy(Path(__file__).with_name(name), tmp_path)
    monkeypatch.chdir(tmp_path)
    for name in ("mine", "broken"):  # other tests bring others of these names
        monkeypatch.delitem(sys.modules, name, raising=False)
    return tmp_path
