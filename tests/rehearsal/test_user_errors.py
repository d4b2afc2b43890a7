"""Whatever the user got wrong is one line that names it, exit 2, and no traceback."""

from pathlib import Path

import pytest

from laglab.command import main

WRONG = [
    (["run", "fig9"], "fig9: no such scenario"),
    (["run", "fig6", "-n", "-1"], "command_delay"),
    (["run", "fig6", "-m", "-3"], "measurement_delay"),
    (["run", "fig6", "-m", "some"], "'-m'"),
    (["run", "fig6", "--start", "1,2"], "start"),
    (["run", "fig6", "--start", "1,2,east"], "start: '1,2,east' is not X,Y,THETA"),
    (["run", "fig6", "--goal", "nan,0,0"], "goal"),
    (["run", "fig6", "--initial-estimate", "somewhere"], "initial_estimate"),
    (["run", "fig6", "--estimator", "best"], "estimator: 'best' is not one of raw, ekf"),
    (["run", "fig6", "--p0", "-1"], "initial_covariance"),
    (["run", "fig6", "--v-max", "0"], "v_max"),
    (["run", "fig6", "--omega-max", "inf"], "omega_max"),
    (["run", "fig6", "--goal-tolerance", "-1"], "goal_tolerance"),
    (["run", "fig6", "--duration", "0"], "duration"),
    (["run", "fig6", "--duration", "0.001"], "duration"),
    (["run", "fig6", "--fmi", "4"], "fmi"),
    (["run", "fig6", "--seed", "-1"], "seed"),
    (["run", "fig6", "--transport", "pigeon"], "'--transport'"),
    (["run", "fig6", "--colour", "red"], "--colour"),
    (["gateway", "fig6", "--endpoint", "smoke://signals"], "smoke"),
    (["controller", "fig6", "--endpoint", "serial:///dev/ttyNONE9:57600"], "/dev/ttyNONE9"),
    (["run", "lab", "--transport", "inline", "--plant", "pty://p"], "--plant: a real robot does"),
    (["gateway", "lab", "--plant", "/dev/ttyNONE9,57600"], "/dev/ttyNONE9"),
    (["gateway", "lab", "--plant", "udpin://0.0.0.0:0"], "can be reached from outside"),
    (["compare", "nowhere"], "nowhere"),
]


@pytest.mark.parametrize(("arguments", "named"), WRONG, ids=lambda value: str(value)[:60])
def test_one_line_names_the_field(
    arguments: list[str],
    named: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as ended:
        main(arguments)
    output = capsys.readouterr()
    assert ended.value.code == 2
    assert named in output.err
    assert len(output.err.splitlines()) == 1
    assert output.out == ""


BROKEN_FILES = {
    "colour = 'red'": "colour: unknown key",
    "command_delay = -1": "command_delay",
    "command_delay = 1.5": "command_delay",
    "start = [1.0, 2.0]": "start",
    "start = 'here'": "start",
    "noise = 'perhaps'": "noise",
    "not toml at all": "not a readable TOML file",
    "compare = ['raw']": "compare",
    "measurement_variance = [0.0, 0.1, 0.1]": "measurement_variance",
}


@pytest.mark.parametrize("text", BROKEN_FILES)
def test_a_bad_scenario_file_names_file_and_field(
    text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "own.toml"
    path.write_text(text)
    with pytest.raises(SystemExit) as ended:
        main(["run", str(path), "--out", str(tmp_path / "out")])
    error = capsys.readouterr().err
    assert ended.value.code == 2
    assert "own.toml" in error
    assert BROKEN_FILES[text] in error
    assert len(error.splitlines()) == 1
    assert not (tmp_path / "out").exists()
