"""The commands of docs/releasing.md."""

import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "releasing.md").read_text(encoding="utf-8")


def releasing(part: str) -> list[str]:
    """The lines of its blocks that have this in them."""
    blocks = re.findall(r"```sh\n(.*?)```", PAGE, re.DOTALL)
    return [line for block in blocks for line in block.splitlines() if part in line]


def in_shell(command: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Runs such a line as a maintainer does, in the environment of the tests."""
    settings = {
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        # Each build compiles all by itself, and leaves nothing at home.
        "ZIG_GLOBAL_CACHE_DIR": str(folder.parent / "zig"),
    }
    return subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env=os.environ | settings,
        capture_output=True,
        text=True,
        check=False,
    )


def build(clone: Path) -> Path:
    """Builds as docs/releasing.md has it: the folder with the sdist and the wheel."""
    (command,) = releasing("-m build")
    done = in_shell(command, clone)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return clone / "dist"
