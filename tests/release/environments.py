"""Environments to install a release into."""

import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path


class Environment:
    """A fresh virtual environment and a folder to work in."""

    def __init__(self, python: str, folder: Path) -> None:
        self._bin = folder / "environment" / "bin"
        self.folder = folder / "work"
        self.folder.mkdir()
        subprocess.run([python, "-m", "venv", "--without-pip", self._bin.parent], check=True)

    def install(self, *what: str) -> None:
        """As wheels alone: nothing may need a compiler."""
        pip = f"{sys.base_prefix}/bin/python3", "-m", "pip", "--python", str(self._bin / "python")
        command = [*pip, "install", "-q", "--only-binary", ":all:", *what]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr

    def laglab(self, line: str) -> str:
        """Runs a command as a user types it: what it prints."""
        return said([self._bin / "laglab", *line.split()], self.folder)

    def imports(self, module: str) -> None:
        """Loads what no short command reaches."""
        said([self._bin / "python", "-c", f"import {module}"], self.folder)


def said(command: Sequence[str | Path], folder: Path) -> str:
    """Runs a command, which is to succeed: what it prints."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, f"{command}: {done.stdout[-1000:]}{done.stderr[-2000:]}"
    return done.stdout
