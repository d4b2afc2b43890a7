"""`laglab check`: what ships keeps its interface, and each way to break it fails one row."""

import math
from collections.abc import Callable, Iterable
from pathlib import Path

import pytest

from laglab.check import CheckOrder, checked, checked_apart, estimator, law
from laglab.check.finding import NotSoError, all_hold
from laglab.check.subject import Kind, kind_of
from laglab.errors import LaglabError, ScenarioError
from laglab.scenario.tables.plant import SHIPPED as PLANTS
from laglab_control import ESTIMATORS, LAWS, Demand, PluginError, PolarLaw
from laglab_control.estimators.family import estimator_kind

Refused = Callable[..., str]
Ended = Callable[..., tuple[int, str, str]]

ROWS: list[tuple[Kind, str, str, str]] = [
    ("estimator", "mine:WrongSignature", "interface", "must be correct(state, measurements, inp"),
    ("estimator", "mine:Nan", "interface", "must answer a finite array x"),
    ("estimator", "broken:Impure", "pure", "predict answers twice differently"),
    ("estimator", "broken:Mutating", "pure", "correct changes the state that it is given"),
    ("estimator", "broken:Sharing", "pure", "calls that were made twice leave something behind"),
    ("estimator", "broken:Unordered", "order", "another order"),
    ("estimator", "broken:Repeating", "repeats", "repeated measurements make"),
    ("estimator", "broken:Late", "delays", "60 ticks late"),
    ("estimator", "broken:AnyStamp", "stamps", "tick -1 at tick 5 raises no StampError"),
    ("estimator", "broken:NoOptimum", "optimum", "standard deviations from delayed-ekf"),
    ("estimator", "broken:Overconfident", "NEES", "on average, not within"),
    ("law", "broken:NoLaw", "interface", "must be drive(pose, time, memory)"),
    ("law", "broken:Infinite", "finite", "ZeroDivisionError"),
    ("law", "broken:Huge", "finite", "must answer v, omega and a memory, not (1000"),
    ("law", "broken:Dicing", "deterministic", "twice differently"),
    ("law", "broken:Appending", "memory", "asked again with its memory"),
    ("plant", "broken:ShortReading", "interface", "must answer x, y, theta"),
    ("plant", "broken:Unseeded", "deterministic", "the same seed gives other readings"),
    ("plant", "broken:Stirring", "still", "two readings of one tick"),
    ("plant", "broken:Immovable", "placing", "place(2.0, -1.0, 0.25)"),
    ("plant", "broken:Degrees", "units", "it turns by"),
]


@pytest.mark.parametrize("name", ESTIMATORS)
def test_the_estimators_that_ship_keep_the_interface_or_say_what_they_do_not(name: str) -> None:
    found = {finding.name: finding.held for finding in checked("estimator", name)}
    assert len(found) == 9
    admitted = [check for check, held in found.items() if held == "admitted"]
    assert admitted == list(ESTIMATORS[name].admits)
    assert "no" not in found.values()
    assert found["optimum"] == ("yes" if name == "delayed-ekf" else "-")


@pytest.mark.usefixtures("brought")
@pytest.mark.parametrize(
    ("kind", "name"),
    [
        *(("law", name) for name in LAWS),
        *(("plant", name) for name in PLANTS),
        ("law", "mine:Law"),
        ("plant", "broken:RightPlant"),
        ("plant", "broken:Plain"),
    ],
)
def test_what_is_right_passes(kind: Kind, name: str) -> None:
    assert kind_of(name, None) == kind
    assert {finding.held for finding in checked(kind, name)} == {"yes"}


@pytest.mark.usefixtures("brought")
@pytest.mark.parametrize(("kind", "name", "row", "said"), ROWS)
def test_each_way_to_break_it_fails_one_row(kind: Kind, name: str, row: str, said: str) -> None:
    found = list(checked(kind, name))
    (failed,) = (finding for finding in found if finding.held == "no")
    assert failed.name == row
    assert said in failed.said
    assert not all_hold(found)


@pytest.mark.usefixtures("brought")
def test_a_filter_that_is_too_slow_for_its_ticks(monkeypatch: pytest.MonkeyPatch) -> None:
    slow = estimator_kind("broken:Slow").make(estimator.MODEL)
    monkeypatch.setattr("broken.Slow.seconds", 0.011)
    with pytest.raises(NotSoError, match="ms a tick, which lasts 10 ms"):
        estimator.cost(estimator.Subject(slow, optimal=True))


@pytest.mark.usefixtures("brought")
def test_what_is_admitted_fails_nothing() -> None:
    found = list(checked("estimator", "broken:Admitting"))
    (admitted,) = (finding for finding in found if finding.held == "admitted")
    assert admitted.name == "NEES"
    assert admitted.said.startswith("we say so (NEES ")
    assert all_hold(found)


def test_speeds_that_are_not_finite_are_found() -> None:
    class Lost(PolarLaw):
        def drive(self, pose: Iterable[float], time: float, memory: object) -> Demand:
            far = math.hypot(*list(pose)[:2]) > 500 and time > 1
            return Demand(math.nan if far else 0.1, 0.0, memory)

    with pytest.raises(NotSoError, match="v = nan"):
        law.finite(Lost())


@pytest.mark.usefixtures("brought")
def test_the_command_says_it_in_a_table_and_an_exit_code(ended: Ended) -> None:
    code, out, _ = ended("check", "mine:Law")
    assert code == 0
    assert "mine:Law keeps the interface of a law" in out
    code, out, _ = ended("check", "broken:Appending")
    assert code == 1
    assert "does not keep the interface of a law" in out
    assert [line.split()[1] for line in out.splitlines()[1:5]] == ["yes", "yes", "yes", "no"]
    assert ended("check", "broken:RightPlant")[0] == 0


@pytest.mark.usefixtures("brought")
@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nobody"], "no estimator, law or plant 'nobody': take one of raw, ekf"),
        (["broken:made_by_a_function"], "say which, with --as estimator|law|plant"),
        (["broken:Nobody"], "broken:Nobody: AttributeError"),
        (["nobody", "--as", "law"], "no law 'nobody': take one of polar, tracking"),
        (["polar", "--option", "gain"], "--option gain: must be KEY=VALUE"),
    ],
)
def test_what_cannot_be_checked_is_one_line(
    refused: Refused, arguments: list[str], said: str
) -> None:
    assert said in refused("check", *arguments)


@pytest.mark.usefixtures("brought")
@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("broken:NoLaw", "cannot be made: TypeError"),
        ("polar", "polar has none, so leave nonsense out"),
    ],
)
def test_options_that_it_does_not_have_fail_its_first_row(
    ended: Ended, name: str, said: str
) -> None:
    code, out, _ = ended("check", name, "--option", "nonsense=2")
    assert code == 1
    assert said in " ".join(out.split())


@pytest.mark.usefixtures("brought")
def test_the_kind_is_known_by_name_or_methods() -> None:
    assert kind_of("popf", None) == "estimator"
    assert kind_of("mine:Wide", None) == "estimator"
    assert kind_of("broken:made_by_a_function", "estimator") == "estimator"
    with pytest.raises(ScenarioError):
        kind_of("broken:made_by_a_function", None)
    with pytest.raises(PluginError):
        list(checked("law", "nobody"))


@pytest.mark.usefixtures("brought")
@pytest.mark.parametrize(
    ("name", "patience", "said"),
    [
        pytest.param(
            *("broken:Sleeping", 9.0, "it did not answer within 9 s"), marks=pytest.mark.slow
        ),
        ("broken:Leaving", 60.0, "the check's process ended with exit code 7 and no word"),
    ],
)
def test_what_never_answers_or_ends_the_process_fails_its_row(
    name: str, patience: float, said: str
) -> None:
    kind, found = checked_apart(CheckOrder(name, None, ()), patience)
    assert kind == "law"
    assert found == [("interface", "no", said)]


def test_a_module_that_never_loads(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "endless.py").write_text("import time\ntime.sleep(3600)\n")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(LaglabError, match="it did not answer within 1 s") as raised:
        checked_apart(CheckOrder("endless:Law", None, ()), patience=1.0)
    assert raised.value.exit_code == 1
