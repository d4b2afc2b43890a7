"""Each side alone, where only what it needs is installed."""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from laglab import extras
from laglab.errors import MissingExtraError

OPTIONS = ("lab", "--duration", "0.5", "--endpoint")


@contextmanager
def ending(process: "subprocess.Popen[str]") -> Iterator["subprocess.Popen[str]"]:
    """Whatever happens here, it does not go on."""
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


class Machine:
    """A fresh virtual environment with laglab as `pip install '.[EXTRA]'` leaves it."""

    def __init__(self, folder: Path, clone: Path, install: Callable[..., Path]) -> None:
        self._folder = folder
        self._clone = clone
        self._install = install

    def install(self, what: str) -> None:
        self._python = self._install(what, self._clone)

    def has(self, module: str) -> bool:
        found = [self._python, "-c", f"import {module}"]
        return subprocess.run(found, stderr=subprocess.DEVNULL, check=False).returncode == 0

    def start(self, *arguments: str) -> "subprocess.Popen[str]":
        return subprocess.Popen(
            [self._python.parent / "laglab", *arguments],
            cwd=self._folder,
            env={key: value for key, value in os.environ.items() if key != "PYTHONPATH"},
            stderr=subprocess.PIPE,
            text=True,
        )

    def refuses(self, *arguments: str) -> str:
        """The one line that says what is missing."""
        process = self.start(*arguments)
        _, errors = process.communicate(timeout=30)
        assert process.returncode == 2
        assert len(errors.splitlines()) == 1
        return errors


def test_no_command_loads_what_it_does_not_need() -> None:
    heavy = "fmpy", "matplotlib", "pyarrow", "scipy", "mcap", "bokeh"
    asked = f"print([name for name in {heavy} if name in sys.modules])"
    script = [sys.executable, "-c", f"import sys, laglab.command; {asked}"]
    loaded = subprocess.run(script, capture_output=True, text=True, check=True)
    assert loaded.stdout == "[]\n"


@pytest.mark.parametrize("missing", [{"bokeh"}, {"bokeh", "pip"}])
def test_where_no_pip_is_installed_another_one_is_told_where_to(
    missing: set[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(extras, "find_spec", lambda name: None if name in missing else name)
    with pytest.raises(MissingExtraError, match=r"pip install 'laglab\[see\]'") as refused:
        extras.require(extras.SEEING)
    assert (f"pip --python {sys.executable}" in str(refused.value)) == ("pip" in missing)


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_each_side_runs_where_only_what_it_needs_is_installed(
    bare_clone: Path,
    tmp_path: Path,
    install_afresh: Callable[..., Path],
    listening_port: Callable[["subprocess.Popen[str]"], str],
) -> None:
    machine = Machine(tmp_path, bare_clone, install_afresh)
    machine.install(".[controller]")
    assert not machine.has("fmpy")
    assert not machine.has("matplotlib")
    assert "pip install 'laglab[gateway]'" in machine.refuses("gateway", "lab")
    assert "pip install 'laglab[run]'" in machine.refuses("run", "lab")
    assert "pip install 'laglab[see]'" in machine.refuses("report", "runs/lab")
    for robot in ("robot", "car", "omni"):
        assert "pip install 'laglab[gateway]'" in machine.refuses("check", robot)

    ours = [sys.executable, "-m", "laglab", "gateway", *OPTIONS, "udpin://127.0.0.1:0"]
    with ending(subprocess.Popen(ours, stderr=subprocess.PIPE, text=True)) as gateway:
        station = machine.start(
            "controller", *OPTIONS, f"udpout://127.0.0.1:{listening_port(gateway)}"
        )
        assert "Traceback" not in station.communicate(timeout=40)[1]
        assert (station.returncode, gateway.wait(10)) == (0, 0)

    machine.install(".[gateway]")
    assert machine.has("fmpy")
    assert not machine.has("matplotlib")
    with ending(machine.start("gateway", *OPTIONS, "udpin://127.0.0.1:0")) as gateway:
        station = machine.start(
            "controller", *OPTIONS, f"udpout://127.0.0.1:{listening_port(gateway)}"
        )
        assert "Traceback" not in station.communicate(timeout=40)[1]
        assert (station.returncode, gateway.wait(10)) == (0, 0)
    assert "matplotlib is not installed" in machine.refuses("run", "lab")
