"""The Python way in, as a script and as a notebook use it."""

import json
import re
import signal
import subprocess
import sys
import textwrap
import time
from collections.abc import Callable
from pathlib import Path

import nbclient
import nbformat
import numpy as np
import pytest

import laglab
from laglab.errors import ScenarioError
from laglab_control import Controller, StationConfig

DOCS = Path(__file__).parents[2] / "docs"
PAGES = [(DOCS / name).read_text(encoding="utf-8") for name in ("python.md", "studies.md")]
BLOCKS = re.findall(r"^```python\n(.*?)^```", "\n".join(PAGES), re.DOTALL | re.M)


def test_import_is_light() -> None:
    heavy = (
        "numpy",
        "pydantic",
        "matplotlib",
        "serial",
        "pymavlink",
        "typer",
        "fmpy",
        "pandas",
        "pyarrow",
    )
    script = f"import sys, laglab; print([name for name in {heavy} if name in sys.modules])"
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert done.stdout == "[]\n"


def test_the_mathematics_load_numpy_and_little_else() -> None:
    heavy = "pydantic", "matplotlib", "serial", "pymavlink", "msgspec", "fastcrc", "hdrh", "typer"
    script = f"import sys, laglab_control; print([n for n in {heavy} if n in sys.modules])"
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert done.stdout == "[]\n"


def test_a_run_in_memory_is_spelled_without_its_arrays() -> None:
    assert "array(" not in repr(laglab.run("fig6", {"duration": 0.2}))


@pytest.mark.slow
def test_a_plain_script_needs_no_guard_and_prints_nothing_of_ours(tmp_path: Path) -> None:
    """The blocks of the pages one after the other, then runs over UDP and a pty."""
    script = tmp_path / "plain.py"
    more = 'for way in ("udp", "serial"):\n    laglab.run("fig6", {"duration": 0.5}, way)\n'
    script.write_text("\n".join([*BLOCKS, "print('the end of the page')", more]), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-W", "error", script],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert done.stdout.endswith("the end of the page\n")
    assert "link.command_delay" in done.stdout
    assert (tmp_path / "fig8.pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.slow
def test_a_notebook(tmp_path: Path) -> None:
    """With a cell for each block; a run over UDP from a notebook too; figures show themselves."""
    cells = [*BLOCKS, 'laglab.run("fig6", {"duration": 0.5}, transport="udp").figure()']
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
    client = nbclient.NotebookClient(
        notebook, timeout=60, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}
    )
    client.execute()
    streams = [
        out for cell in notebook.cells for out in cell.outputs if out.get("name") == "stderr"
    ]
    assert streams == []
    assert "image/png" in notebook.cells[-1].outputs[0]["data"]


def test_in_memory_and_on_disk_are_the_same_run(tmp_path: Path) -> None:
    overrides = {"duration": 1.0, "estimator.compare": ["ekf", "popf"]}
    kept = laglab.run("lab-radio", overrides)
    written = laglab.run("lab-radio", overrides, out=tmp_path / "run")
    apart = laglab.run("lab-radio", overrides, transport="udp")
    opened = laglab.open_run(tmp_path / "run")
    for other in (written, apart, opened):
        assert set(kept.trace) == set(other.trace)
        for name, column in kept.trace.items():
            np.testing.assert_array_equal(column, other.trace[name], err_msg=name)
        for name, cells in kept.link.items():
            np.testing.assert_array_equal(cells, other.link[name], err_msg=name)
        assert kept.summary.rms_error == other.summary.rms_error
        assert kept.summary.compare == other.summary.compare
    assert kept.directory is None
    assert len(kept.timing["tick"]) == 0
    assert set(json.loads((tmp_path / "run" / "summary.json").read_text())["compare"]) == {
        "delayed-ekf", "ekf", "popf",
    }  # fmt: skip


def test_a_scenario_can_be_handed_over_and_overridden() -> None:
    scenario = laglab.load("fig6", {"duration": 0.2})
    assert laglab.run(scenario).summary.ticks == 20
    assert laglab.run(scenario, {"duration": 0.3}).summary.ticks == 30
    assert scenario.duration == 0.2
    link, events = {"command_delay": 3}, [{"at": 1.0, "by": np.array([0.1, 0.0, 0.0])}]
    overrides = {
        "link": link,
        "plant.event": events,
        "link.command_delay": 4,
        "plant.event.0.at": 2.0,
    }
    changed = laglab.load("fig6", overrides)
    assert (changed.link.command_delay, changed.plant.event[0].at) == (4, 2.0)
    assert (link["command_delay"], events[0]["at"]) == (3, 1.0), "they are the caller's"


def test_what_is_wrong_is_said_by_an_error_of_ours(tmp_path: Path) -> None:
    with pytest.raises(laglab.ScenarioError, match="no such scenario"):
        laglab.run("fig99")
    with pytest.raises(laglab.ScenarioError, match=r"link\.command_delay"):
        laglab.run("fig6", {"link.command_delay": -1})
    with pytest.raises(laglab.ResultsError):
        laglab.open_run(tmp_path)
    (tmp_path / "file").touch()
    with pytest.raises(laglab.PlaceError, match="that is a file"):
        laglab.run("fig6", out=tmp_path / "file")


def test_another_runs_results_are_replaced_when_asked(tmp_path: Path) -> None:
    laglab.run("fig6", {"duration": 0.1}, out=tmp_path)
    with pytest.raises(laglab.PlaceError, match="force=True"):
        laglab.run("fig6", {"duration": 0.2}, out=tmp_path)
    laglab.run("fig6", {"duration": 0.2}, out=tmp_path, force=True)
    assert laglab.open_run(tmp_path).summary.ticks == 20


def test_a_diverged_run_is_a_result() -> None:
    run = laglab.run("fig8", {"estimator.initial_covariance": 0.1, "duration": 60.0})
    assert run.summary.outcome == "diverged"
    assert not run.summary.converged


@pytest.mark.parametrize("transport", ["inline", "udp", "serial"])
def test_ctrl_c_leaves_nothing_running(
    tmp_path: Path, start_program: Callable[..., "subprocess.Popen[str]"], transport: str
) -> None:
    script = textwrap.dedent(f"""
        import laglab
        laglab.run("lab", {{"duration": 3600.0}}, transport={transport!r}, out="run")
    """)
    process = start_program(sys.executable, "-c", script)
    trace = tmp_path / "run" / "trace.csv"
    deadline = time.monotonic() + 20
    while not trace.exists() or trace.stat().st_size < 5000:
        assert time.monotonic() < deadline
        time.sleep(0.02)
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=20)
    assert errors.rstrip().endswith("KeyboardInterrupt")
    assert not [child for child in children if Path(f"/proc/{child}").exists()]
    assert json.loads((tmp_path / "run" / "summary.json").read_text())["outcome"] == "interrupted"


def test_a_transport_that_is_none_is_refused() -> None:
    with pytest.raises(laglab.ScenarioError, match="take one of inline, udp, serial"):
        laglab.run("fig6", transport="telepathy")  # type: ignore[arg-type]


def test_another_controller_is_called_wherever_the_results_go(tmp_path: Path) -> None:
    made = []

    def make(config: StationConfig) -> Controller:
        made.append(config)
        return Controller(config)

    short = {"duration": 0.1}
    laglab.run("fig6", short, controller=make)
    laglab.run("fig6", short, out=tmp_path / "run", controller=make)
    assert len(made) == 2
    with pytest.raises(ScenarioError, match="controller: udp has the station in a process"):
        laglab.run("fig6", short, transport="udp", controller=make)
