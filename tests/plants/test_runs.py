"""Runs with anyone's FMU in the robot's place: the same bytes by every way, and what goes wrong."""

import json
import shutil
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from laglab.command import main
from laglab.last_resort import UNHEARD
from laglab.runs.plant import open_plant
from laglab.scenario import Scenario, load
from laglab_gateway import read_trace

from .building import ROVER_MAP

LAW = """
goal = [0.4, 0.1, 0.0]
start = [0.0, 0.0, 0.0]
duration = 3.0
estimator.kind = "delayed-ekf"
law = { v_max = 1.0, omega_max = 1.7, goal_tolerance = 0.03 }
link = { command_delay = 3, measurement_delay = 5 }
"""
ROVER = f'{LAW}\n[plant]\nfmu = "fmus/rover.fmu"{ROVER_MAP}'
BARROW = f"""{LAW}
[plant]
fmu = "fmus/Barrow.fmu"
inputs = {{ v = "twist[0]", omega = "twist[1]" }}
outputs = {{ x = "pose[0]", y = "pose[1]", theta = "pose[2]" }}
"""
TRAY = f"""{LAW}
[plant]
fmu = "fmus/Tray.fmu"
inputs = {{ v = "forward", omega = "turning" }}
outputs = {{ x = "pose[1]", y = "pose[2]", theta = "pose[3]" }}
"""
SENSOR = 'x_meas = "gps.x", y_meas = "gps.y", theta_meas = "compass"'

Scenarios = Callable[[str], Path]
Ran = tuple[int, str]


@pytest.fixture
def written(tmp_path: Path, fmus: Path) -> Scenarios:
    """A scenario's file, with the FMUs in a folder beside it."""
    (tmp_path / "fmus").symlink_to(fmus)

    def write(text: str) -> Path:
        (tmp_path / "own.toml").write_text(text)
        return tmp_path / "own.toml"

    return write


@pytest.fixture
def run(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> Callable[..., Ran]:
    """`laglab run ARGUMENTS`: the exit code, and what it says on standard error; results in out."""

    def call(*arguments: object, out: str = "out") -> Ran:
        with pytest.raises(SystemExit) as ended:
            main(["run", *map(str, arguments), "--out", str(tmp_path / out)])
        assert isinstance(ended.value.code, int)
        return ended.value.code, capfd.readouterr().err

    return call


@pytest.mark.parametrize(
    ("text", "ways"),
    [
        (ROVER, ("inline", "udp", "serial")),
        pytest.param(BARROW, ("inline", "udp"), marks=pytest.mark.slow),
        pytest.param(TRAY, ("inline", "udp"), marks=pytest.mark.slow),
    ],
)
def test_the_same_bytes_by_every_way(
    written: Scenarios, run: Callable[..., Ran], tmp_path: Path, text: str, ways: tuple[str, ...]
) -> None:
    scenario = written(text)
    for way in ways:
        told = ("--noise", "--duration", 1.0, "--transport", way)
        assert run(scenario, *told, out=way)[0] == 0
    assert len({(tmp_path / way / "trace.csv").read_bytes() for way in ways}) == 1


def test_in_real_time(written: Scenarios, run: Callable[..., Ran], tmp_path: Path) -> None:
    scenario = written(ROVER)
    code, _ = run(scenario, "--pace", "realtime", "--duration", 0.5)
    assert code == 0
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["ticks"] == 50


def test_model_exchange_goes_the_same_way(written: Scenarios, run: Callable[..., Ran]) -> None:
    assert run(written(ROVER.replace("rover.fmu", "rover-me.fmu")), "--transport", "inline")[0] == 0


def test_our_sensor_s_noise_is_the_documented_one(written: Scenarios) -> None:
    scenario = load(str(written(ROVER)), {"noise": True, "seed": 7})
    noise = np.random.default_rng((7, 2)).standard_normal((3, 3)) * np.sqrt([0.01, 0.01, 0.018])
    with open_plant(scenario) as opened:
        for k in range(3):
            reading = opened.plant.read()
            assert np.array(reading[3:6]) - reading[:3] == pytest.approx(noise[k])
            opened.plant.step(0.5, 0.1)


def test_without_noise_the_pose_is_measured(written: Scenarios) -> None:
    with open_plant(load(str(written(BARROW)))) as opened:
        opened.plant.step(0.5, 0.1)
        reading = opened.plant.read()
    assert reading[:3] == reading[3:6]
    assert reading[6:] == (0.5, 0.1)


def test_a_sensor_of_its_own_is_believed(written: Scenarios) -> None:
    text = ROVER.replace('theta = "psi" }', f'theta = "psi", {SENSOR} }}')
    with open_plant(load(str(written(text)), {"noise": True})) as opened:
        reading = opened.plant.read()
    errors = np.array(reading[3:6]) - reading[:3]
    assert (np.abs(errors) <= 0.01).all()
    assert errors.any()


def test_somebody_moves_it(written: Scenarios, run: Callable[..., Ran], tmp_path: Path) -> None:
    event = "\n[[plant.event]]\nat = 1.0\nplace = [1.0, 1.0, 0.5]\n"
    code, said = run(
        written(ROVER + event), "--transport", "inline", "--set", "plant.parameters.wheel.base=0.6"
    )
    assert (code, said) == (0, "")
    trace = read_trace(tmp_path / "out" / "trace.csv")
    assert trace["x"][100] == 1.0
    assert abs(trace["x"][99]) < 0.5
    code, said = run(written(BARROW + event), "--transport", "inline", out="other")
    assert code == 2
    assert said.startswith(
        "laglab: plant.event: nobody can put Barrow.fmu elsewhere: map its start"
    )


def test_a_start_that_is_the_fmu_s_own_is_told(written: Scenarios, run: Callable[..., Ran]) -> None:
    scenario = written(TRAY)
    _, said = run(scenario, "--transport", "udp")
    assert said.count("warning: Tray.fmu starts at (1, 0.5, 0), not at the scenario's start") == 1
    _, said = run(scenario, "--transport", "inline", "--start", "1,0.5,0", out="other")
    assert said == ""


@pytest.mark.parametrize("transport", ["inline", "udp"])
def test_what_fails_ends_the_run_and_leaves_the_record(
    written: Scenarios, run: Callable[..., Ran], tmp_path: Path, transport: str
) -> None:
    scenario = written(ROVER + "parameters = { fail_at = 1.005 }\n")
    code, said = run(scenario, "--transport", transport)
    assert code == 4
    lines = said.splitlines()
    assert lines[0] == (
        "laglab: rover.fmu: tick 100: fmi2DoStep failed (error), inputs "
        "drive.cmd_left=2.74957, drive.cmd_right=-2.74957; the left motor is on fire at 1 s"
    )
    assert len(read_trace(tmp_path / "out" / "trace.csv")["tick"]) == 100


@pytest.mark.slow
def test_what_never_returns_is_named(
    written: Scenarios, run: Callable[..., Ran], tmp_path: Path
) -> None:
    text = f"silence_timeout = 2.0{ROVER}parameters = {{ hang_at = 1.005 }}\n"
    code, said = run(written(text), "--transport", "udp")
    assert code == 4
    assert "silent for 2 s, since its tick 100" in said
    assert "the robot's process does not go on: it may be that rover.fmu does not return" in said
    assert len(read_trace(tmp_path / "out" / "trace.csv")["tick"]) > 90


@pytest.mark.slow
def test_what_never_returns_is_ended_by_ctrl_c(
    written: Scenarios, start_program: Callable[..., Any], tmp_path: Path
) -> None:
    """Where there is no process of its own to end; what was recorded stays."""
    scenario = written(ROVER + "parameters = { hang_at = 1.005 }\n")
    arguments = ("-m", "laglab", "run", str(scenario), "--transport", "inline", "--out", "out")
    process = start_program(sys.executable, *arguments)
    trace = tmp_path / "out" / "trace.csv"
    while not (trace.exists() and trace.read_bytes().count(b"\n") > 90):
        assert process.poll() is None
        time.sleep(0.1)
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=UNHEARD + 20)
    assert process.returncode == 130
    assert errors.splitlines()[-1] == "laglab: interrupted"
    assert len(read_trace(trace)["tick"]) > 90
    assert not list(tmp_path.parent.glob(f"*/laglab-fmu-{process.pid}-*"))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (('"fmus/rover.fmu"', '"fmus/none.fmu"'), "none.fmu: there is no such file"),
        (('"posX"', '"posx"'), "plant.outputs.x: rover.fmu has no variable 'posx'; did you mean"),
        (('x = "posX", ', ""), "own.toml: plant.outputs: give x, y and theta"),
        (("omega_left", "v"), "plant.inputs: give either v and omega, or omega_left and"),
        (("inputs =", "input ="), "plant.input: unknown key; did you mean plant.inputs"),
        (("outputs = ", "parameters = "), "plant: with fmu give inputs and outputs"),
        (("[plant]", '[plant]\nkind = "robot2"'), "plant: give either kind or fmu"),
    ],
)
def test_what_is_wrong_before_is_one_line(
    written: Scenarios,
    run: Callable[..., Ran],
    tmp_path: Path,
    change: tuple[str, str],
    said: str,
) -> None:
    scenario = written(ROVER.replace(*change))
    code, told = run(scenario)
    assert code == 2
    assert said in told
    assert told.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_the_file_is_beside_the_scenario_wherever_one_stands(
    written: Scenarios,
    run: Callable[..., Ran],
    tmp_path: Path,
    fmus: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scenario = written(BARROW)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert run(scenario, "--transport", "udp", "--duration", 0.1)[0] == 0
    kept = (tmp_path / "out" / "scenario.toml").read_text()
    assert 'Barrow.fmu"' in kept
    assert str(tmp_path) not in kept
    again = load(str(tmp_path / "out" / "scenario.toml"))
    assert again.plant.fmu == (fmus / "Barrow.fmu").resolve()
    assert Scenario.from_toml(again.to_toml()) == again


def test_parameters_may_be_tables(written: Scenarios) -> None:
    scenario = load(
        str(written(ROVER + 'parameters.wheel.base = 1.0\nparameters."wheel.radius" = 0.1'))
    )
    assert scenario.plant.parameters == {"wheel.base": 1.0, "wheel.radius": 0.1}
    assert Scenario.from_toml(scenario.to_toml()) == scenario


def test_a_copied_folder_runs_there(
    written: Scenarios, run: Callable[..., Ran], tmp_path: Path
) -> None:
    scenario = written(ROVER)
    moved = tmp_path / "moved"
    shutil.copytree(scenario.parent / "fmus", moved / "fmus")
    shutil.copy(scenario, moved)
    assert run(moved / "own.toml", "--transport", "inline", "--duration", 0.1)[0] == 0
