"""The blocks of code on a page, and what it takes to do what they say."""

import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

BLOCK = re.compile(r"(?:^<!-- not run: (.+?) -->\n+)?^```(\w+)\n(.*?)^```$", re.M | re.S)
NAME = re.compile(r"# (\S+\.(?:toml|py|csv|txt|dist))\b")
RUN = ("sh", "python", "toml", "csv")
"""Blocks in other languages are output, equations and definitions, unless they name a file."""
PORT = re.compile(r"(?<=127\.0\.0\.1:)\d{4,5}\b")
SECONDS = 120
ROOT = Path(__file__).parents[2]


class Block(NamedTuple):
    """One on a page."""

    language: str
    text: str
    not_run: str | None
    """Why it is not run here."""

    @property
    def file(self) -> str | None:
        """What the reader is to save it as: its first line is a comment that names it."""
        found = NAME.match(self.text)
        return found and found[1]


def blocks(page: Path) -> list[Block]:
    """Those that a reader would copy."""
    found = BLOCK.findall(page.read_text(encoding="utf-8"))
    there = [Block(language, text, why or None) for why, language, text in found]
    return [block for block in there if block.language in RUN or block.file]


def do(page: Path, folder: Path) -> None:
    """All that the page says, one after the other, in a folder."""
    names: dict[str, object] = {"__name__": "page"}
    ports: dict[str, str] = {}
    for block in blocks(page):
        if block.file:
            (folder / block.file).write_text(block.text, encoding="utf-8")
        elif block.not_run:
            continue
        elif block.language == "sh":
            _shell(PORT.sub(lambda port: _free(ports, port[0]), block.text), folder)
        elif block.language == "python":
            exec(compile(block.text, str(page), "exec"), names)


def _free(ports: dict[str, str], written: str) -> str:
    """A port that the system has free, the same for every time it is written on the page."""
    if written not in ports:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.bind(("127.0.0.1", 0))
            ports[written] = str(probe.getsockname()[1])
    return ports[written]


def _shell(script: str, folder: Path) -> None:
    """With this environment's programs first; what it leaves in the background is ended, and its
    temporary files are gone."""
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    with (
        tempfile.TemporaryFile("w+") as said,
        tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as temporary,
    ):
        process = subprocess.Popen(
            ["bash", "-euo", "pipefail", "-c", script],
            cwd=folder,
            env={**os.environ, "PATH": path, "LAGLAB": str(ROOT), "TMPDIR": temporary},
            stdout=said,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        try:
            code = process.wait(timeout=SECONDS)
        finally:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        said.seek(0)
        assert code == 0, f"{script}\n{said.read()}"
