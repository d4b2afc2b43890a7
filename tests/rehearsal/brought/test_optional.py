"""What a filter may have besides what it must: wrong answers are told, as all others are."""

from collections.abc import Callable
from pathlib import Path

import pytest

from laglab.check import checked
from laglab.runs import rehearse
from laglab.runs.whole import run_into
from laglab.scenario import Scenario, load
from laglab_gateway import MemoryRecorder
from laglab_station.report import Calibrated

Ended = Callable[..., tuple[int, str, str]]

INLINE = ("run", "lab", "--duration", "1", "--transport", "inline", "--out", "run")
INNOVATIONS = (
    *("Two", "One", "Four", "Lists", "Column"),
    *("Variances", "Keyed", "Nan", "Single", "Torn", "Once"),
)
INNOVATION = "must answer None, or a finite array z - h(x) (3,) and its S (3, 3), not "
WAY = "calibrated.way must answer a finite x, y and theta, not "
WAYS = {
    "NoRobot": (0, "calibrated must answer a robot with a method way(u), not None"),
    "NoWay": (41, f"{WAY}None"),
    "NanWay": (41, f"{WAY}Way("),
    "TextWay": (41, f"{WAY}'xyt'"),
    "FailingWay": (41, "calibrated.way: ValueError: lost (optional.py, line"),
}
PARAMETERS = {
    "NoParameters": "not None",
    "Numbers": "not [1, 2]",
    "NanParameter": "not [('track', nan",
    "HugeParameter": "not ",
    "Nameless": "not [(None, 1.0",
}
PARAMETER = "must answer a name, a finite value and its deviation for each parameter, "


@pytest.mark.usefixtures("brought")
@pytest.mark.parametrize("name", INNOVATIONS)
def test_under_a_guard_an_innovation_that_is_none_ends_the_run(name: str) -> None:
    told = {"estimator.kind": f"optional:{name}", "duration": 1.0}
    recorder = MemoryRecorder()
    ending = rehearse.rehearse_inline(load("lab", told), recorder)
    assert ending.exit_code == 4
    assert ending.problem.startswith(f"tick 40: optional:{name}.innovation {INNOVATION}")
    assert 41 <= len(recorder.rows) <= 42


@pytest.mark.usefixtures("brought")
def test_beside_the_loop_it_costs_the_run_nothing(ended: Ended) -> None:
    code, _, stderr = ended(*INLINE, "--set", 'estimator.compare=["optional:Two"]')
    assert code == 0, stderr
    assert f"warning: tick 40: optional:Two.innovation {INNOVATION}" in stderr


def unguarded(name: str) -> Scenario:
    return load("lab", {"estimator.kind": name, "estimator.guard": False, "duration": 1.0})


@pytest.mark.usefixtures("brought")
@pytest.mark.parametrize("name", WAYS)
def test_a_robot_that_is_none_ends_the_run(name: str) -> None:
    ending = rehearse.rehearse_inline(unguarded(f"optional:{name}"), MemoryRecorder())
    assert ending.exit_code == 4
    tick, said = WAYS[name]
    assert ending.problem.startswith(f"tick {tick}: optional:{name}.{said}")


@pytest.mark.usefixtures("brought")
@pytest.mark.parametrize(
    ("name", "transport"), [*((name, "inline") for name in PARAMETERS), ("Numbers", "udp")]
)
def test_parameters_that_are_none_are_a_warning(
    tmp_path: Path, name: str, transport: rehearse.Transport
) -> None:
    """The run is over by then."""
    told = unguarded(f"optional:{name}")
    ending = run_into(tmp_path / "run", told, transport, rehearse.unheard)
    assert ending.exit_code == 0
    assert ending.station is not None
    (warning,) = ending.warnings
    assert warning.startswith(f"optional:{name}.learned {PARAMETER}{PARAMETERS[name]}")


@pytest.mark.usefixtures("brought")
@pytest.mark.parametrize("transport", ["inline", "udp"])
def test_what_is_right_is_taken(tmp_path: Path, transport: rehearse.Transport) -> None:
    told = unguarded("optional:Learning")
    ending = run_into(tmp_path / "run", told, transport, rehearse.unheard)
    assert (ending.exit_code, ending.warnings) == (0, ("tick 20: two lines",))
    assert ending.station is not None
    assert ending.station.calibration == (Calibrated("track", 1.01, 0.0),)


@pytest.mark.usefixtures("brought")
def test_a_warning_that_is_no_text_is_one_itself() -> None:
    ending = rehearse.rehearse_inline(unguarded("optional:Warnings"), MemoryRecorder())
    said = "tick 20: optional:Warnings.warning must answer a text or None, not ['two', 'texts']"
    assert ending.warnings == (said,)


@pytest.mark.usefixtures("brought")
@pytest.mark.parametrize(
    ("name", "said"),
    [
        *((name, f"innovation {INNOVATION}") for name in INNOVATIONS),
        *((name, said) for name, (_, said) in WAYS.items()),
        *((name, f"learned {PARAMETER}") for name in PARAMETERS),
        ("Warnings", "warning must answer a text or None"),
        ("NoExpectation", "expect must answer a state with tick, x and P, not None"),
        ("NoRestart", "restart must answer a state with tick, x and P, not None"),
    ],
)
def test_the_check_finds_it(name: str, said: str) -> None:
    (failed,) = checked("estimator", f"optional:{name}")
    assert failed[:2] == ("interface", "no")
    assert f"optional:{name}.{said}" in failed.said
