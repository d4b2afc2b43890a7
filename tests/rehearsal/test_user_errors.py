"""Whatever the user got wrong is one line that names it, exit 2, and no traceback."""

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

Refused = Callable[..., str]
WRONG = [
    (["run", "fig9"], "fig9: no such scenario"),
    (["report", "gone"], "gone is not there: name the folder of a run"),
    (["plant", "check", "boat:Boat"], "`laglab check boat:Boat` looks at it"),
    (["rivals", "--estimator", "popf"], "No such option: --estimator"),
    (["errata", "--estimator", "popf"], "No such option: --estimator"),
    (["run", "fig6", "--transport", "tcp"], "Invalid value for '--transport': 'tcp' is not one of"),
    (["run", "x" * 300], "File name too long"),
    (["run", "x\0y"], "embedded null byte"),
    (["run", "fig6", "-n", "-1"], "command_delay"),
    (["run", "fig6", "-m", "-3"], "measurement_delay"),
    (["run", "fig6", "-m", "some"], "'-m'"),
    (["run", "fig6", "-m", "65535"], "link.measurement_delay: must be below 65535, not 65535"),
    (["run", "fig6", "-n", "9" * 30], "link.command_delay: must be below 65535"),
    (["run", "fig6", "--set", f"start={'[' * 3000}"], "is no TOML value: nested too deeply"),
    (["run", "fig6", "--timeline", "/dev/null"], "a timeline is a list of [[event]] tables"),
    (["run", "fig6", "--timeline", sys.executable], "nor the link.csv of a run"),
    (["run", "fig6", "--timeline", "/"], "--timeline /: Is a directory"),
    (["run", "fig6", "--start", "1,2"], "start"),
    (
        ["run", "fig6", "--start", "1,2,east"],
        "start: must be three finite numbers, x, y and theta, not '1,2,east'",
    ),
    (["run", "fig6", "--goal", "nan,0,0"], "goal"),
    (["run", "fig6", "--initial-estimate", "somewhere"], "initial_estimate"),
    (["run", "fig6", "--estimator", "best"], "estimator.kind: must be one of raw, ekf"),
    (["run", "fig6", "--p0", "-1"], "initial_covariance"),
    (["run", "fig6", "--v-max", "0"], "v_max"),
    (["run", "fig6", "--omega-max", "inf"], "omega_max"),
    (["run", "fig6", "--goal-tolerance", "-1"], "goal_tolerance"),
    (["run", "fig6", "--duration", "0"], "duration"),
    (["run", "fig6", "--duration", "0.001"], "duration"),
    (["run", "fig6", "--fmi", "4"], "fmi"),
    (
        ["run", "fig6", "--fmi", "2", "--set", "plant.kind=mine:R"],
        "plant.fmi: mine:R is as it was",
    ),
    (
        ["controller", "track-eight", "--goal-tolerance", "1"],
        "law.goal_tolerance: the law tracking",
    ),
    (["run", "fig6", "--seed", "-1"], "seed"),
    (["run", "fig6", "--transport", "pigeon"], "'--transport'"),
    (["run", "fig6", "--colour", "red"], "--colour"),
    (["run", "fig6", "--set", "seed"], "--set seed: must be KEY=VALUE"),
    (["run", "fig6", "--set", "start=[1,"], "--set start=[1,: '[1,' is no TOML value"),
    (["run", "fig6", "--set", "comand_delay=1"], "fig6: comand_delay: unknown key; did you mean"),
    (["run", "fig6", "--set", "start.x=1"], "fig6: start.x: must be the number of an element"),
    (["run", "fig6", "--set", "seed=1", "--set", "seed.x=1"], "fig6: seed: must be a table to"),
    (["gateway", "fig6", "--endpoint", "smoke://signals"], "smoke"),
    (["gateway", "fig6", "--endpoint", "udpin://a..b:1"], "no such host 'a..b'"),
    (["controller", "fig6", "--endpoint", f"udpout://{'a' * 70}:1"], "no such host"),
    (["conform", "smoke://signals", "--side", "robot"], "smoke"),
    (["controller", "fig6", "--endpoint", "serial:///dev/ttyNONE9:57600"], "/dev/ttyNONE9"),
    (["run", "lab", "--transport", "inline", "--plant", "pty://p"], "--plant: a real robot does"),
    (["gateway", "lab", "--plant", "/dev/ttyNONE9,57600"], "/dev/ttyNONE9"),
    (["run", "lab", "--plant", "pty://p", "--fmi", "2"], "plant.fmi: the robot at pty://p has"),
    (["gateway", "lab", "--plant", "pty://p", "--pace", "realtime"], "pace: the robot at pty://p"),
    (["gateway", "lab", "--plant", "pty://p", "--set", "speed=2"], "speed: the robot at pty://p"),
    (
        ["gateway", "lab", "--plant", "pty://p", "--set", "plant.wheel_slip=0.1"],
        "plant.wheel_slip: the robot at pty://p",
    ),
    (
        ["run", "lab", "--plant", "pty://p", "--set", "plant.outputs.x=pose"],
        "plant.outputs.x: the robot at pty://p",
    ),
    (["gateway", "lab", "--plant", "udpin://0.0.0.0:0"], "can be reached from outside"),
    (["compare", "nowhere"], "nowhere"),
]


@pytest.mark.parametrize(("arguments", "named"), WRONG, ids=lambda value: str(value)[:60])
def test_one_line_names_the_field(
    arguments: list[str],
    named: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    refused: Refused,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert named in refused(*arguments)


BROKEN_FILES = {
    "colour = 'red'": "colour: unknown key; known here: name, description, start",
    "command_delay = 3": "command_delay: unknown key; did you mean link.command_delay",
    "link.comand_delay = 3": "link.comand_delay: unknown key; did you mean link.command_delay",
    "lnk.command_delay = 3": "lnk: unknown key; did you mean link",
    "link.command.fog = 1": "link.command.fog: unknown key; known here: loss, reorder",
    "link.command.burst.loss_god = 1": "link.command.burst.loss_god: unknown key; did you mean "
    "link.command.burst.loss_good",
    "link = 3": "link: must be a table, not 3",
    "link.command = 0.1": "link.command: must be a table, not 0.1",
    "link.command_delay = -1": "link.command_delay: must be 0 or more, not -1",
    "link.command_delay = 1.5": "link.command_delay: must be a whole number of ticks, not 1.5",
    "link.command_delay = '3'": "link.command_delay: must be a whole number of ticks, not '3'",
    "link.command.loss = 7": "link.command.loss: must be 1 or less, not 7",
    "link.event = [{at = 1.0}, {at = -1.0}]": "link.event.1.at: must be 0 or more, not -1.0",
    "link.event = {at = 1.0}": "link.event: must be a list, not {'at': 1.0}",
    "link.replay = 'none.csv'": "none.csv is not a readable link log",
    "link.command.outages = [[1.0]]": "link.command.outages: must be a list of [start, duration]",
    "start = [1.0, 2.0]": "start: must be three finite numbers, x, y and theta, not [1.0, 2.0]",
    "start = [1.0, 2.0, '3']": "start: must be three finite numbers",
    "start = 'here'": "start: must be three finite numbers, x, y and theta, not 'here'",
    "start = { x = 1.0 }": "start: must be three finite numbers",
    "goal = [2000.0, 0.0, 0.0]": "start: must be within 1000 m of the goal, not [-3.0, -3.0, 0.0]",
    "noise = 'perhaps'": "noise: must be true or false, not 'perhaps'",
    "noise = 1": "noise: must be true or false, not 1",
    "seed = { first = 1 }": "seed: must be a whole number, not {'first': 1}",
    "seed = 2147483648": "seed: must be below 2147483648, not 2147483648",
    "seed = true": "seed: must be a whole number, not True",
    "seed = 2020-01-01": "seed: must be a whole number, not datetime.date(2020, 1, 1)",
    "speed = nan": "speed: must be a finite number, not nan",
    "duration = nan": "duration: must be above 0, not nan",
    "duration = 1e9": "duration: must be 4294967295 ticks or less, not 1e+11",
    "name = 3": "name: must be text, not 3",
    "law.lambda = 0.0": "law.lambda: must be above 0, not 0.0",
    "law.v_max = inf": "law.v_max: must be a finite number, not inf",
    "pace = 'slow'": "pace: must be 'lockstep' or 'realtime', not 'slow'",
    "not toml at all": "not a readable TOML file",
    "estimator.kind = 'best'": "estimator.kind: must be one of raw, ekf, popf",
    "estimator.initial_estimate = 'here'": "estimator.initial_estimate: must be 'start', 'drawn' "
    "or three finite numbers, x, y and theta, not 'here'",
    "estimator.compare = ['raw']": "estimator.compare: must not be 'raw'",
    "estimator.compare = 'ekf'": "estimator.compare: must be a list, not 'ekf'",
    "plant.measurement_variance = [0.0, 0.1, 0.1]": "plant.measurement_variance: must be three "
    "variances above 0, of x, y and theta, not [0.0, 0.1, 0.1]",
    "safety.ramp = -1.0": "safety.ramp: must be 0 or more, not -1.0",
    f"seed = {'[' * 3000}": "not a readable TOML file: nested too deeply",
    f"seed{'.a' * 3000} = 1": "not a readable TOML file: nested too deeply",
    f"seed = 1{'0' * 5000}": "not a readable TOML file",
    f"name = [{'1,' * 5000}]": "name: must be text, not [1, 1, 1",
}


@pytest.mark.parametrize("text", BROKEN_FILES)
def test_a_bad_scenario_file_names_file_and_field(
    text: str, tmp_path: Path, refused: Refused
) -> None:
    path = tmp_path / "own.toml"
    path.write_text(text)
    line = refused("run", path, "--out", tmp_path / "out")
    assert line.startswith(f"laglab: {path}: ")
    assert BROKEN_FILES[text] in line
    assert len(line) < 400
    assert not (tmp_path / "out").exists()
