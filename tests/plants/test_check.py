"""`laglab plant check`: what it proposes runs, and what is wrong with a robot is its exit code."""

import re
import tempfile
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

from laglab import run
from laglab.command import main
from laglab.plants.proposal import words
from laglab_fmu import fleet_path, fmu_path

from .building import CO_SIMULATION, MODEL_EXCHANGE, rover

Checked = tuple[int, str, str]
Check = Callable[..., Checked]
SENSOR = {"x_meas": "gps.x", "y_meas": "gps.y", "theta_meas": "compass"}
MAPS = {
    "rover.fmu": {
        "inputs": {"omega_left": "drive.cmd_left", "omega_right": "drive.cmd_right"},
        "outputs": {"x": "posX", "y": "posY", "theta": "psi", **SENSOR},
        "start": {"x": "posX_0", "y": "posY_0", "theta": "psi_0"},
    },
    "Barrow.fmu": {
        "inputs": {"v": "twist[0]", "omega": "twist[1]"},
        "outputs": {"x": "pose[0]", "y": "pose[1]", "theta": "pose[2]"},
    },
    "Tray.fmu": {
        "inputs": {"v": "forward", "omega": "turning"},
        "outputs": {"x": "pose[1]", "y": "pose[2]", "theta": "pose[3]"},
    },
}
MAPS["rover-me.fmu"] = MAPS["rover.fmu"]


@pytest.fixture
def check(capfd: pytest.CaptureFixture[str]) -> Check:
    """`laglab plant check ARGUMENTS`: exit code, standard output and error."""

    def call(*arguments: object) -> Checked:
        with pytest.raises(SystemExit) as ended:
            main(["plant", "check", *map(str, arguments)])
        said = capfd.readouterr()
        return int(ended.value.code or 0), said.out, said.err

    return call


@pytest.fixture(scope="module")
def kept() -> dict[str, Checked]:
    """What was said of an FMU as it is, for the tests that ask the same."""
    return {}


@pytest.fixture
def as_it_is(check: Check, fmus: Path, kept: dict[str, Checked]) -> Callable[[str], Checked]:
    """What is said of this FMU of `fmus`, checked once."""

    def call(name: str) -> Checked:
        if name not in kept:
            kept[name] = check(fmus / name)
        return kept[name]

    return call


def printed_toml(output: str) -> str:
    """From the first line that is of a scenario."""
    found = re.search(r"^(start = |\[plant\]).*", output, flags=re.M | re.S)
    assert found, output
    return found[0]


@pytest.mark.parametrize("name", MAPS)
def test_what_is_proposed_runs(
    as_it_is: Callable[[str], Checked], fmus: Path, tmp_path: Path, name: str
) -> None:
    code, out, err = as_it_is(name)
    assert (code, err) == (0, "")
    assert "yes, twice the same bits" in out
    assert "0.3 m after 1 s" in out
    text = printed_toml(out)
    assert tomllib.loads(text)["plant"] == {"fmu": name, **MAPS[name]}
    (tmp_path / name).symlink_to(fmus / name)
    (tmp_path / "own.toml").write_text(text)
    assert run(tmp_path / "own.toml", {"duration": 0.2}).summary.ticks == 20


def test_the_page_s_example_is_what_is_printed(as_it_is: Callable[[str], Checked]) -> None:
    page = (Path(__file__).parents[2] / "docs" / "plants.md").read_text("utf-8")
    shown, own = re.findall(r"^```(?:toml)?\n(.*?)^```", page, flags=re.M | re.S)[:2]
    _, out, _ = as_it_is("Tray.fmu")
    assert tomllib.loads(printed_toml(out)) == tomllib.loads(own)
    told = [" ".join(line.split()) for line in out.splitlines() if "speed " not in line]
    for line in shown.splitlines():
        assert "speed " in line or " ".join(line.split()) in told


def test_versions_interfaces_and_platforms_are_told(as_it_is: Callable[[str], Checked]) -> None:
    said = "rover.fmu: FMI 2.0, co-simulation and model exchange; for linux64"
    assert said in as_it_is("rover.fmu")[1]
    said = "Barrow.fmu: FMI 3.0, co-simulation; for x86_64-linux, x86_64-windows"
    assert said in as_it_is("Barrow.fmu")[1]


@pytest.mark.parametrize("version", [2, 3])
def test_our_own_is_found_out(check: Check, version: int) -> None:
    code, out, _ = check(fmu_path(version))
    assert code == 0
    plant = tomllib.loads(printed_toml(out))["plant"]
    assert plant["inputs"] == {"omega_left": "omega_left", "omega_right": "omega_right"}
    assert plant["outputs"]["theta_meas"] == "theta_meas"
    assert plant["start"]["theta"] == "theta_start"


def test_a_robot_of_arrays_of_one_is_found_out(check: Check) -> None:
    code, out, _ = check(fleet_path())
    assert code == 0
    assert tomllib.loads(printed_toml(out))["plant"]["outputs"]["theta"] == "theta[0]"


@pytest.mark.parametrize(
    ("parameter", "code", "said"),
    [
        ("dice=1.0", 1, "deterministic  NO"),
        ("fail_at=0.5", 1, "rover.fmu: tick 50: fmi2DoStep failed (error), inputs drive.cmd_left="),
        ("crash_at=0.5", 1, "rover.fmu: the plant's process was killed by SIGABRT"),
        ("nan_at=0.0", 1, "rover.fmu: tick 0: posX is nan"),
        ("wheel.radius=0.5", 0, "3 m after 1 s at 0.3 m/s: is that the speed, in m/s"),
        ("wheel.radius=0.0", 1, "IT DOES NOT MOVE"),
        ("wheel.tyre=0.0", 2, "no variable 'wheel.tyre'; did you mean"),
    ],
)
def test_what_is_wrong_is_the_exit_code(
    check: Check,
    fmus: Path,
    parameter: str,
    code: int,
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv("TMPDIR", str(tmp_path))  # for children that are not told of another
    found, out, err = check(fmus / "rover.fmu", "--set", f"plant.parameters.{parameter}")
    assert found == code
    assert said in out + err
    assert not out.endswith("\n\n")
    assert err.count("\n") <= 1
    assert list(tmp_path.iterdir()) == []  # what crashed had unpacked something


def test_what_cannot_be_used(check: Check, tmp_path: Path, library: Path) -> None:
    code, _, err = check(tmp_path / "none.fmu")
    assert (code, err) == (2, f"laglab: {tmp_path}/none.fmu: there is no such file\n")
    code, _, err = check(rover(tmp_path / "away.fmu", library, platform="win64"))
    assert code == 2
    assert "no binary for this machine (linux64), but: win64" in err


def test_an_fmu_that_is_unpacked_is_told_so(check: Check, tmp_path: Path) -> None:
    (tmp_path / "rover.fmu").mkdir()
    code, _, err = check(tmp_path / "rover.fmu")
    said = "rover.fmu is a folder: an FMU is a zip archive of what is in it\n"
    assert (code, err) == (2, f"laglab: {tmp_path}/{said}")


@pytest.mark.parametrize("interface", [CO_SIMULATION, MODEL_EXCHANGE])
def test_a_library_that_is_not_named_is_told(
    check: Check, tmp_path: Path, library: Path, interface: str
) -> None:
    nameless = interface.replace('modelIdentifier="rover"', "")
    code, _, err = check(rover(tmp_path / "rover.fmu", library, [nameless]))
    assert code == 2
    assert err.endswith(" has no modelIdentifier, the name of its library\n")
    assert err.count("\n") == 1


def test_names_that_say_nothing_are_asked_for(check: Check, tmp_path: Path, library: Path) -> None:
    names = {"drive.cmd_left": "in1", "drive.cmd_right": "in2"}
    file = rover(tmp_path / "odd.fmu", library, names=names)
    code, out, err = check(file)
    assert code == 2
    assert "in1" in out
    assert err.startswith(f"laglab: {file}: its names do not say which are the command")
    assert err.count("\n") == 1
    code, out, _ = check(
        *(file, "--set", "plant.inputs.omega_left=in1", "--set", "plant.inputs.omega_right=in2")
    )
    assert code == 0
    assert tomllib.loads(printed_toml(out))["plant"]["inputs"]["omega_left"] == "in1"


def test_a_scenario_s_robot_is_driven_too(
    check: Check, as_it_is: Callable[[str], Checked], fmus: Path, tmp_path: Path
) -> None:
    (tmp_path / "Tray.fmu").symlink_to(fmus / "Tray.fmu")
    _, out, _ = as_it_is("Tray.fmu")
    (tmp_path / "own.toml").write_text(printed_toml(out))
    code, out, _ = check(tmp_path / "own.toml")
    assert code == 0
    assert "starts at      (1, 0.5, 0)" in out
    assert check("lab")[0] == 0


def test_names_are_read_by_their_words() -> None:
    assert words("drive.cmdLeft_0") == {"drive", "cmd", "left", "0"}
    assert words("posX") == {"pos", "x"}
    assert words("der(psi)") == {"der", "psi"}
