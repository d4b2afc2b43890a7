"""The other robots that ship: how they move, and that they are FMUs as the first one is."""

import cmath
import math
import re
import subprocess
import sys
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu

from laglab_fmu.foreign import FmuFile, ForeignRobot, Value, Wiring
from laglab_fmu.models import MODELS, Model

TS = 0.01
STATES = ("x", "y", "theta")
OTHERS = ("Car2", "Car3", "CarFleet3", "Omni2", "Omni3", "OmniFleet3")
Parameters = dict[str, Value]


def driven(
    path: Path, v: float, omega: float, ticks: int = 100, exchange: bool = False, **told: Value
) -> list[tuple[float, ...]]:
    """x, y, theta, v, omega, tick by tick."""
    outputs = {name: name for name in (*STATES, "v", "omega")}
    inputs = {"v": "v_command", "omega": "omega_command"}
    file = FmuFile.read(path)
    if exchange:
        file.description.coSimulation = None
    with ForeignRobot(file, Wiring(inputs, outputs, parameters=told), TS) as robot:
        return [robot.step((v, omega)) for _ in range(ticks)]


@pytest.mark.parametrize("name", OTHERS)
def test_fmpy_finds_no_problem(fmus: dict[str, Path], name: str) -> None:
    assert validate_fmu(str(fmus[name])) == []
    for variable in fmpy.read_model_description(fmus[name]).modelVariables:
        assert variable.description
        if variable.type in ("Real", "Float64"):
            assert variable.declaredType.displayUnit


def test_the_manipulation_toolbox_finds_no_error(fmus: dict[str, Path]) -> None:
    command = [sys.executable, "-m", "fmu_manipulation_toolbox.cli.fmutool"]
    done = subprocess.run(
        [*command, "-input", str(fmus["Car3"]), "-check"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert "seems to be compliant" in done.stdout + done.stderr


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
def test_its_documentation_is_its_own(extracted: dict[str, Path], model: Model) -> None:
    page = (extracted[f"{model.name}3"] / "documentation" / "index.html").read_text()
    assert f"<title>{model.name}</title>" in page
    assert model.description in page
    assert f"<code>{model.fleet}3.fmu</code>" in page
    named = set(re.findall(r"<code>(\w+_\w+)</code>", page))
    assert named <= {variable.name for variable in model.variables}


def test_all_that_ship_are_built(fmus: dict[str, Path]) -> None:
    assert list(fmus) == [name for model in MODELS for name in model.fmus]


@pytest.mark.parametrize("name", ["Car", "Omni"])
def test_fmi_2_and_3_give_the_same_bits(fmus: dict[str, Path], name: str) -> None:
    told: Parameters = {"seed": 5, "first_wheel_error": 0.1} if name == "Omni" else {"seed": 5}
    assert driven(fmus[f"{name}2"], 0.5, 0.3, **told) == driven(fmus[f"{name}3"], 0.5, 0.3, **told)


@pytest.mark.parametrize("name", ["Car3", "Omni3"])
def test_model_exchange_goes_the_same_way(fmus: dict[str, Path], name: str) -> None:
    told: Parameters = {"seed": 5, "integration": 2}
    stepped, solved = (driven(fmus[name], 0.5, 0.3, exchange=way, **told) for way in (False, True))
    assert np.array(solved)[-1, :3] == pytest.approx(np.array(stepped)[-1, :3], abs=5e-4)


def test_the_car_s_steering_lags_and_has_an_end(fmus: dict[str, Path]) -> None:
    told: Parameters = {"noise": False, "steering_time_constant": 0.1, "wheelbase": 0.5}
    turns = [row[4] for row in driven(fmus["Car3"], 0.5, 0.3, **told)]
    steering = math.atan(0.5 * 0.3 / 0.5)
    lagged = [steering * (1 - math.exp(-(k + 1) * TS / 0.1)) for k in range(1, 100)]
    assert turns[:-1] == pytest.approx([0.5 * math.tan(each) / 0.5 for each in lagged])
    sharp = driven(fmus["Car3"], 0.5, 5.0, ticks=300, steering_max=0.6, **told)
    assert sharp[-1][4] == pytest.approx(math.tan(0.6))
    assert driven(fmus["Car3"], 0.0, 1.0, **told)[-1] == (0.0,) * 5
    back = driven(fmus["Car3"], -0.5, 0.3, ticks=300, **told)
    assert back[-1][3:] == pytest.approx((-0.5, 0.3))


def test_the_omnidirectional_one_does_as_told_and_slides_on_a_worn_wheel(
    fmus: dict[str, Path],
) -> None:
    x, y, theta, v, omega = driven(fmus["Omni3"], 0.5, 0.0, noise=False)[-1]
    assert (x, y, theta, v, omega) == pytest.approx((0.5, 0.0, 0.0, 0.5, 0.0), abs=1e-12)
    assert driven(fmus["Omni3"], 0.0, 0.3, noise=False)[-1][:3] == pytest.approx((0, 0, 0.3))
    worn = driven(fmus["Omni3"], 0.5, 0.0, ticks=1, noise=False, first_wheel_error=-0.1)[-1]
    rim = 0.1 * 0.5 * math.sqrt(0.75)  # what the worn wheel lacks
    assert worn[1] == pytest.approx(TS * rim / 3)
    assert worn[3] == pytest.approx(0.5 - 2 / 3 * math.sqrt(0.75) * rim)
    assert worn[4] == pytest.approx(rim / (3 * 0.2))


def test_what_slides_while_it_turns_follows_its_arc(fmus: dict[str, Path]) -> None:
    """By the chord, which is shorter than the arc and points half of the turn further."""
    told: Parameters = {"noise": False, "first_wheel_error": -0.5}
    euler, arc = (
        driven(fmus["Omni3"], 5.0, 60.0, ticks=1, integration=how, **told)[0] for how in (1, 2)
    )
    speed, a = complex(euler[0], euler[1]) / TS, TS * arc[4] / 2
    assert abs(speed.imag) > 0.1
    expected = TS * speed * math.sin(a) / a * cmath.exp(1j * a)
    assert complex(arc[0], arc[1]) == pytest.approx(expected)
