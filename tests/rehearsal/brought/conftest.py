"""A folder with what somebody brought, in which the commands are run."""

import shutil
from pathlib import Path

import pytest


@pytest.fixture
def brought(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """With `mine`, `broken`, `derived` and `optional` in it; the current directory."""
    names = ("mine", "broken", "derived", "optional")
    for name in names:
        shutil.copy(Path(__file__).with_name(f"{name}.py"), tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path
