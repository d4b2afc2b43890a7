"""Anyone's FMU, stepped: by name, whatever its version, its interface and its arrays."""

import math
import shutil
import zipfile
from pathlib import Path

import pytest

from laglab_fmu import CallError, FmuFileError, fmu_path
from laglab_fmu.foreign import FmuFile, ForeignRobot, Wiring, check
from laglab_fmu.foreign.steps import substeps

from .building import CO_SIMULATION, FIXED_STEP, MODEL_EXCHANGE, rover

TS = 0.01
WHEELS = {"omega_left": "drive.cmd_left", "omega_right": "drive.cmd_right"}
POSE = {"x": "posX", "y": "posY", "theta": "psi"}
START = {"x": "posX_0", "y": "posY_0", "theta": "psi_0"}
ROVER = Wiring(WHEELS, POSE, START)
BARROW = Wiring(
    {"v": "twist[0]", "omega": "twist[1]"},
    {"x": "pose[0]", "y": "pose[0, 1]", "theta": "pose[2]"},
)
TRAY = Wiring(
    {"v": "forward", "omega": "turning"}, {"x": "pose[1]", "y": "pose[2]", "theta": "pose[3]"}
)

TOLD = r", inputs drive\.cmd_left=1, drive\.cmd_right=1"


def driven(
    file: Path, wiring: Wiring, inputs: tuple[float, float], ticks: int = 100
) -> list[float]:
    """Its outputs after so many ticks."""
    start = (0.0,) * len(wiring.start)
    with ForeignRobot(FmuFile.read(file), wiring, TS, start) as robot:
        for _ in range(ticks):
            robot.step(inputs)
        return list(robot.outputs)


def euler(
    v: float, omega: float, step: float, pose: tuple[float, ...] = (0.0, 0.0, 0.0)
) -> list[float]:
    """(3) over 1 s."""
    x, y, theta = pose
    for _ in range(round(1 / step)):
        x, y = x + step * v * math.cos(theta), y + step * v * math.sin(theta)
        theta += step * omega
    return [x, y, theta]


def test_co_simulation_with_other_names(fmus: Path) -> None:
    pose = driven(fmus / "rover.fmu", ROVER, (10.0, 14.0))
    assert pose == pytest.approx(euler(0.6, 1 / 3, 0.005), abs=1e-12)


def test_model_exchange_by_fmpy_s_solver(fmus: Path) -> None:
    x, y, theta = driven(fmus / "rover-me.fmu", ROVER, (10.0, 14.0))
    v, omega = 0.6, 1 / 3
    assert theta == pytest.approx(omega, abs=1e-6)
    assert (x, y) == pytest.approx(
        (v / omega * math.sin(omega), v / omega * (1 - math.cos(omega))), abs=1e-4
    )


@pytest.mark.parametrize("version", [2, 3])
def test_model_exchange_meets_its_time_events(version: int) -> None:
    """Our own robot samples its noise at events: with it, the path is another at every sample."""
    file = FmuFile.read(fmu_path(version))
    wiring = Wiring(
        {"left": "omega_left", "right": "omega_right"},
        {"theta": "theta", "measured": "theta_meas"},
        parameters={"seed": 3},
    )
    with ForeignRobot(file, wiring, TS) as robot:
        expected = [robot.step((1.0, 1.0)) for _ in range(50)]
    file.description.coSimulation = None
    with ForeignRobot(file, wiring, TS) as robot:
        found = [robot.step((1.0, 1.0)) for _ in range(50)]
    assert len({measured for _, measured in found}) == 50
    for one, other in zip(found, expected, strict=True):
        assert one == pytest.approx(other, abs=1e-4)


def test_model_exchange_meets_its_state_events(fmus: Path) -> None:
    wiring = Wiring(WHEELS, POSE, START, {"wall_at": 0.3})
    assert driven(fmus / "rover-me.fmu", wiring, (10.0, 10.0)) == pytest.approx([0.3, 0.0, 0.0])


def test_arrays_of_fmi_3(fmus: Path) -> None:
    assert driven(fmus / "Barrow.fmu", BARROW, (0.5, 0.3)) == pytest.approx(euler(0.5, 0.3, TS))


def test_flattened_names_of_fmi_2(fmus: Path) -> None:
    there = (1.0, 0.5, 0.0)
    assert driven(fmus / "Tray.fmu", TRAY, (0.5, 0.3)) == pytest.approx(euler(0.5, 0.3, TS, there))


def test_parameters_are_set_by_the_fmu_s_names(fmus: Path) -> None:
    worn = Wiring(BARROW.inputs, BARROW.outputs, parameters={"wear": 0.5})
    assert driven(fmus / "Barrow.fmu", worn, (0.5, 0.3)) == pytest.approx(euler(0.25, 0.15, TS))
    wide = Wiring(WHEELS, POSE, parameters={"wheel.base": 1.2})
    pose = driven(fmus / "rover.fmu", wide, (10.0, 14.0))
    assert pose == pytest.approx(euler(0.6, 1 / 6, 0.005), abs=1e-12)


@pytest.mark.parametrize("name", ["rover.fmu", "rover-me.fmu"])
def test_it_begins_again_elsewhere(fmus: Path, name: str) -> None:
    with ForeignRobot(FmuFile.read(fmus / name), ROVER, TS, (1.0, 2.0, 3.0)) as robot:
        assert robot.outputs == (1.0, 2.0, 3.0)
        robot.step((10.0, 10.0))
        robot.restart((0.5, 0.5, 0.0))
        assert robot.outputs == (0.5, 0.5, 0.0)
        assert robot.step((10.0, 10.0)) == pytest.approx((0.505, 0.5, 0.0))


def test_a_step_of_its_own_is_kept(tmp_path: Path, library: Path) -> None:
    file = FmuFile.read(rover(tmp_path / "rover.fmu", library, [FIXED_STEP]))
    with ForeignRobot(file, ROVER, TS, (0.0, 0.0, 0.0)) as robot:
        robot.step((10.0, 14.0))
        assert robot.outputs[2] == pytest.approx(TS / 3)
    with pytest.raises(FmuFileError, match=r"steps by 0.005 s .* multiple of that, not 0.012"):
        check(file, ROVER, 0.012)
    with pytest.raises(FmuFileError, match=r"not 0\.001"):
        check(file, ROVER, 0.001)


@pytest.mark.parametrize(("sample_time", "parts"), [(0.29, 58), (0.035, 7), (0.005, 1)])
def test_a_sample_is_cut_into_whole_steps_whatever_their_quotient_rounds_to(
    sample_time: float, parts: int, tmp_path: Path, library: Path
) -> None:
    file = FmuFile.read(rover(tmp_path / "rover.fmu", library, [FIXED_STEP]))
    assert substeps(file, sample_time) == parts


@pytest.mark.parametrize("told", ["0", "-0.005", "nan", "inf", "abc"])
@pytest.mark.parametrize(
    ("key", "offered"), [("stepSize", FIXED_STEP), ("tolerance", MODEL_EXCHANGE)]
)
def test_a_step_and_a_tolerance_that_are_no_numbers_above_0_are_refused(
    told: str, key: str, offered: str, tmp_path: Path, library: Path
) -> None:
    path = rover(tmp_path / "rover.fmu", library, [offered], experiment={key: told})
    said = rf"rover.fmu: its modelDescription.xml: {key} must be a number above 0, not {told}"
    with pytest.raises(FmuFileError, match=said):
        check(FmuFile.read(path), ROVER, TS)


@pytest.mark.parametrize("step", ["1e-320", "1e-9"])
def test_steps_of_which_a_sample_has_too_many_are_refused(
    step: str, tmp_path: Path, library: Path
) -> None:
    path = rover(tmp_path / "rover.fmu", library, [FIXED_STEP], experiment={"stepSize": step})
    with pytest.raises(FmuFileError, match=r"it steps by \S+ s .* more than 1000000"):
        check(FmuFile.read(path), ROVER, TS)


@pytest.mark.parametrize(
    ("parameter", "said"),
    [
        ("fail_at", rf"rover.fmu: tick 10: fmi2DoStep failed \(error\){TOLD}; the left motor"),
        ("discard_at", rf"tick 10: fmi2DoStep failed \(discard\){TOLD}; it logged nothing$"),
        ("nan_at", r"rover.fmu: tick 10: posX is nan"),
    ],
)
def test_what_fails_on_the_way_is_told(fmus: Path, parameter: str, said: str) -> None:
    at = 0.105 if parameter != "nan_at" else 0.095
    wiring = Wiring(WHEELS, POSE, START, {parameter: at})
    with pytest.raises(CallError, match=said):
        driven(fmus / "rover.fmu", wiring, (1.0, 1.0))


def test_what_fails_under_the_solver_is_told(fmus: Path) -> None:
    wiring = Wiring(WHEELS, POSE, START, {"fail_at": 0.105})
    with pytest.raises(CallError, match=rf"GetDerivatives failed \(error\){TOLD}; the left"):
        driven(fmus / "rover-me.fmu", wiring, (1.0, 1.0))


def test_a_value_that_is_refused_is_named(fmus: Path) -> None:
    wiring = Wiring(WHEELS, POSE, START, {"wheel.base": -1.0})
    said = r"fmi2SetReal of wheel.base = -1.0 failed; a base of -1 m\?"
    with pytest.raises(CallError, match=said):
        driven(fmus / "rover.fmu", wiring, (1.0, 1.0))


def test_resources_that_are_missing_are_told_by_the_fmu(tmp_path: Path, library: Path) -> None:
    file = FmuFile.read(rover(tmp_path / "rover.fmu", library, [CO_SIMULATION], resources=()))
    with pytest.raises(FmuFileError, match=r"does not start: .*; no gain.txt in my resources"):
        ForeignRobot(file, ROVER, TS)


@pytest.mark.parametrize(
    ("wiring", "said"),
    [
        (Wiring({**WHEELS, "omega_left": "drive.cmdleft"}, POSE), "did you mean drive.cmd_left"),
        (Wiring({**WHEELS, "omega_left": "posX"}, POSE), "posX of rover.fmu is no real input"),
        (Wiring(WHEELS, {**POSE, "x": "zzzzzzz"}), "its outputs: posX, posY"),
        (Wiring(WHEELS, {**POSE, "x": "posX[1]"}), r"outputs.x: .* no variable 'posX\[1\]'"),
        (
            Wiring(dict.fromkeys(WHEELS, "drive.cmd_left"), POSE),
            "inputs.omega_right: drive.cmd_left is inputs.omega_left already",
        ),
        (Wiring(WHEELS, {**POSE, "y": POSE["x"]}), "outputs.y: posX is outputs.x already"),
        (Wiring(WHEELS, {**POSE, "x": "drive.cmd_left"}), "outputs.x: .* is an input"),
        (Wiring(WHEELS, POSE, {"x": "posX_0", "y": "posX_0"}), "start.y: .* is start.x already"),
        (Wiring(WHEELS, POSE, {"x": "posx0"}), "start.x: .*did you mean posX_0"),
        (Wiring(WHEELS, POSE, parameters={"base": 1.0}), "parameters: .* wheel.base"),
    ],
)
def test_wrong_names_are_told_with_what_is_near(fmus: Path, wiring: Wiring, said: str) -> None:
    with pytest.raises(FmuFileError, match=said):
        check(FmuFile.read(fmus / "rover.fmu"), wiring, TS)


@pytest.mark.parametrize(
    ("name", "said"),
    [("pose", r"take one of pose\[0\] to pose\[0,2\]"), ("pose[3]", "has 1 by 3 elements")],
)
def test_elements_that_an_array_does_not_have(fmus: Path, name: str, said: str) -> None:
    wiring = Wiring(BARROW.inputs, {**BARROW.outputs, "x": name})
    with pytest.raises(FmuFileError, match=said):
        check(FmuFile.read(fmus / "Barrow.fmu"), wiring, TS)


def test_files_that_are_none(tmp_path: Path, fmus: Path, library: Path) -> None:
    with pytest.raises(FmuFileError, match="no such file"):
        FmuFile.read(tmp_path / "none.fmu")
    (tmp_path / "text.fmu").write_text("no zip")
    with pytest.raises(FmuFileError, match="is no FMU, or a damaged one"):
        FmuFile.read(tmp_path / "text.fmu")
    with zipfile.ZipFile(tmp_path / "empty.fmu", "w") as archive:
        archive.writestr("readme.txt", "nothing")
    with pytest.raises(FmuFileError, match=r"no modelDescription.xml is in it"):
        FmuFile.read(tmp_path / "empty.fmu")
    with zipfile.ZipFile(rover(tmp_path / "dotted.fmu", library), "a") as archive:
        archive.writestr("./", "")
    assert FmuFile.read(tmp_path / "dotted.fmu").version == 2
    elsewhere = FmuFile.read(rover(tmp_path / "away.fmu", library, platform="win32"))
    with pytest.raises(FmuFileError, match=r"no binary for this machine .*, but: win32"):
        elsewhere.interface()
    whole = (fmus / "rover.fmu").read_bytes()
    (tmp_path / "bitten.fmu").write_bytes(whole[:3000] + bytes(500) + whole[3500:])
    with pytest.raises(FmuFileError, match="damaged"):
        ForeignRobot(FmuFile.read(tmp_path / "bitten.fmu"), ROVER, TS)


def test_nothing_is_left_behind(
    fmus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    driven(fmus / "rover.fmu", ROVER, (1.0, 1.0), ticks=1)
    shutil.copy(fmus / "rover.fmu", tmp_path / "rover.fmu")
    assert [path.name for path in tmp_path.iterdir()] == ["rover.fmu"]
