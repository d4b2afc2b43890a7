"""What is generated of the reference is what the code says now."""

import runpy
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

REFERENCE = Path(__file__).parents[2] / "docs" / "reference"
SCRIPT = REFERENCE / "generate.py"
GENERATED: dict[str, Callable[[], str]] = runpy.run_path(str(SCRIPT))["GENERATED"]


@pytest.mark.parametrize("name", GENERATED)
def test_the_page_is_up_to_date(name: str) -> None:
    written = (REFERENCE / name).read_text(encoding="utf-8")
    assert written == GENERATED[name](), "run: python docs/reference/generate.py"


def test_one_command_writes_them_all(tmp_path: Path) -> None:
    script = tmp_path / SCRIPT.name
    script.write_text(SCRIPT.read_text(encoding="utf-8"), encoding="utf-8")
    subprocess.run([sys.executable, script], check=True, timeout=50)
    for name in GENERATED:
        assert (tmp_path / name).read_bytes() == (REFERENCE / name).read_bytes()
