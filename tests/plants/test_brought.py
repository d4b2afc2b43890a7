"""A robot that somebody brings as a class: it runs in every process, and is watched."""

import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from laglab import run
from laglab.check import checked
from laglab.command import main
from laglab.errors import RunError
from laglab_gateway import read_trace

Laglab = Callable[..., "subprocess.CompletedProcess[str]"]
PAGE = (Path(__file__).parents[2] / "docs" / "plants.md").read_text("utf-8")
FAULTY = """
from ice import Skater

class Raises(Skater):
    def step(self, v, omega):
        self.steps = getattr(self, "steps", 0) + 1
        if self.steps == 7:
            raise ValueError("no ice left\\nhere")
        super().step(v, omega)

class Nowhere(Raises):
    def step(self, v, omega):
        try:
            super().step(v, omega)
        except ValueError:
            self._at((float("nan"), 0.0, 0.0), v, omega)

class Vague(Raises):
    def read(self):
        return super().read() if getattr(self, "steps", 0) < 6 else [1.0, 2.0]

class Huge(Raises):
    def read(self):
        return super().read() if getattr(self, "steps", 0) < 6 else [10**400] * 8

class Tearing(Raises):
    def read(self):
        return super().read() if getattr(self, "steps", 0) < 6 else map(divmod, [1] * 8, [0] * 8)

class Unmade(Skater):
    def __init__(self, *told):
        raise OSError("no rink")

class Half:
    def __init__(self, sample_time, start, seed):
        pass

    def read(self):
        return None
"""


@pytest.fixture
def ice(tmp_path: Path) -> Path:
    """The page's robot, and faulty ones, in the folder where commands run."""
    (tmp_path / "ice.py").write_text(blocks("python")[0])
    (tmp_path / "faulty.py").write_text(FAULTY)
    return tmp_path


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", PAGE, flags=re.M | re.S)


@pytest.fixture
def laglab(tmp_path: Path) -> Laglab:
    """The command, as it is installed: its own path does not have the present folder."""

    def call(*arguments: str) -> "subprocess.CompletedProcess[str]":
        command = [str(Path(sys.executable).parent / "laglab"), *arguments]
        return subprocess.run(
            command, cwd=tmp_path, capture_output=True, text=True, timeout=50, check=False
        )

    return call


Ended = tuple[int, str, str]


@pytest.fixture
def ended(
    ice: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> Callable[..., Ended]:
    """The command in this process: its exit code, what it and its processes said."""
    monkeypatch.chdir(ice)

    def call(*arguments: str) -> Ended:
        with pytest.raises(SystemExit) as ended:
            main(list(arguments))
        said = capfd.readouterr()
        return int(ended.value.code or 0), said.out, said.err

    return call


def test_the_page_s_robot_keeps_the_interface(ice: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ice)
    assert {finding.held for finding in checked("plant", "ice:Skater")} == {"yes"}


def test_the_page_s_robot_runs_the_same_by_every_way(
    ice: Path, laglab: Laglab, ended: Callable[..., Ended]
) -> None:
    (ice / "own.toml").write_text(blocks("toml")[1])
    short = ("run", "own.toml", "--duration", "1")
    code, _, errors = ended(*short, "--transport", "inline", "--out", "inline")
    assert code == 0, errors
    done = laglab(*short, "--transport", "udp", "--out", "udp")
    assert done.returncode == 0, done.stderr
    assert all("plant" in (ice / way / "summary.json").read_text() for way in ("inline", "udp"))
    traces = [(ice / way / "trace.csv").read_bytes() for way in ("inline", "udp")]
    assert traces[0] == traces[1]


def test_what_fails_in_a_process_of_its_own_ends_the_run(
    ice: Path, ended: Callable[..., Ended]
) -> None:
    code, _, errors = ended("run", "fig6", "--set", "plant.kind=faulty:Raises")
    assert code == 4
    said = "laglab: tick 6: faulty:Raises.step: ValueError: no ice left here (faulty.py, line 8)"
    assert errors.splitlines()[0] == said
    assert "Traceback" not in errors
    assert 5 <= len(read_trace(ice / "runs" / "fig6" / "trace.csv")["tick"]) <= 7


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("Raises", "tick 6: faulty:Raises.step: ValueError: no ice left here"),
        ("Nowhere", "tick 7: faulty:Nowhere.read: x must be finite, not nan"),
        ("Vague", r"tick 6: faulty:Vague.read: must answer x, y, theta, .*, not \[1.0, 2.0\]"),
        ("Huge", r"tick 6: faulty:Huge.read: must answer x, y, theta, .*, not \[1000"),
        ("Tearing", r"tick 6: faulty:Tearing.read: must answer x, y, theta, .*, not <map"),
    ],
)
def test_what_it_does_wrong_is_one_line(
    ice: Path, monkeypatch: pytest.MonkeyPatch, name: str, said: str
) -> None:
    monkeypatch.syspath_prepend(str(ice))
    with pytest.raises(RunError, match=said):
        run("fig6", {"plant.kind": f"faulty:{name}"})


@pytest.mark.parametrize("name", ["Huge", "Tearing"])
def test_the_check_finds_what_is_no_reading(
    ice: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.syspath_prepend(str(ice))
    (failed,) = checked("plant", f"faulty:{name}")
    assert failed[:2] == ("interface", "no")
    assert f"faulty:{name}.read: must answer x, y, theta" in failed.said


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("faulty:Unmade", "faulty:Unmade cannot be made: OSError: no rink"),
        ("faulty:Half", "faulty:Half has no method step(v, omega)"),
        ("faulty:Gone", "faulty:Gone: AttributeError: module 'faulty' has no attribute 'Gone'"),
        ("nowhere:Robot", "nowhere:Robot: ModuleNotFoundError: No module named 'nowhere'"),
        ("ice:math", "ice:math: ice:math is no class"),
        ("skater", "no plant 'skater': take one of robot"),
    ],
)
def test_what_cannot_be_made_is_one_line(
    ice: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    kind: str,
    said: str,
) -> None:
    monkeypatch.syspath_prepend(str(ice))
    out = str(ice / "out")
    with pytest.raises(SystemExit) as ended:
        main(["run", "fig6", "--set", f"plant.kind={kind}", "--transport", "inline", "--out", out])
    assert ended.value.code == 2
    told = capsys.readouterr().err
    assert told.startswith(f"laglab: {said}")
    assert told.count("\n") == 1


def test_an_installed_one_is_listed(ice: Path) -> None:
    metadata = ice / "rink-1.2.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: rink\nVersion: 1.2\n")
    entries = "[laglab.plants]\nskater = ice:Skater\nlost = ice:Lost\n"
    (metadata / "entry_points.txt").write_text(entries)
    listed = subprocess.run(
        [sys.executable, "-m", "laglab", "plants"],
        cwd=ice,
        env=os.environ | {"COLUMNS": "200"},
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    rows = [line.split(maxsplit=3) for line in listed.splitlines()]
    assert ["robot", "laglab", "differential"] in [row[:3] for row in rows]
    assert "skater rink 1.2 A unicycle on ice." in " ".join(listed.split())
    assert "lost rink 1.2 lost: AttributeError" in " ".join(listed.split())


def test_it_is_driven_by_the_check(ice: Path, ended: Callable[..., Ended]) -> None:
    (ice / "own.toml").write_text(blocks("toml")[1])
    code, out, errors = ended("plant", "check", "own.toml")
    assert code == 0, errors
    assert "yes, twice the same bits" in out
    assert "can be placed  yes" in out
