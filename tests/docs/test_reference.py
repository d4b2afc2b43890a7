"""What is generated of the reference is what the code says now."""

import re
import runpy
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from laglab.runs.ending import BROKE, EXIT_CODES, KNOWN_BEFORE, STOPPED
from laglab_protocol import EndReason

REFERENCE = Path(__file__).parents[2] / "docs" / "reference"
SCRIPT = REFERENCE / "generate.py"
GENERATED: dict[str, Callable[[], str]] = runpy.run_path(str(SCRIPT))["GENERATED"]


@pytest.mark.parametrize("name", GENERATED)
def test_the_page_is_up_to_date(name: str) -> None:
    written = (REFERENCE / name).read_text(encoding="utf-8")
    assert written == GENERATED[name](), "run: python docs/reference/generate.py"


def test_every_exit_code_is_told_and_every_end_has_one() -> None:
    page = GENERATED["errors.md"]()  # which knows all the errors
    told = {int(code) for code in re.findall(r"^\| (\d+) \|", page, flags=re.M)}
    raised = {int(code) for code in re.findall(r"^\| [· ]*`\w+` \| (\d+) \|", page, flags=re.M)}
    assert raised | {*EXIT_CODES.values(), STOPPED, BROKE, KNOWN_BEFORE} <= told
    assert set(EXIT_CODES) == set(EndReason)


def test_one_command_writes_them_all(tmp_path: Path) -> None:
    script = tmp_path / SCRIPT.name
    script.write_text(SCRIPT.read_text(encoding="utf-8"), encoding="utf-8")
    subprocess.run([sys.executable, script], check=True, timeout=50)
    for name in GENERATED:
        assert (tmp_path / name).read_bytes() == (REFERENCE / name).read_bytes()
