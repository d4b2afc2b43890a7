"""`laglab check`: what ships keeps its interface, and each way to break it fails one row."""

import math
from collections.abc import Callable, Iterable
from pathlib import Path

import pytest

from laglab.check import CheckOrder, checked, checked_apart, law
from laglab.check.finding import NotSoError, all_hold
from laglab.check.subject import Kind, kind_of
from laglab.command import main
from laglab.errors import LaglabError, ScenarioError
from laglab.scenario.tables.plant import SHIPPED as PLANTS
from laglab_control import ESTIMATORS, LAWS, Demand, PluginError, PolarLaw

BROKEN = '''
"""Each is right but for one thing."""
import itertools
import math
import random
import time
from typing import NamedTuple
import numpy as np
from laglab_control import DelayedEkf, Measured, PolarLaw, RigidMotions, StampError


class State(NamedTuple):
    inner: object
    x: object
    P: object
    tick: int


class Right:
    """As good as delayed-ekf."""

    optimal = True

    def __init__(self, model):
        self.ekf = DelayedEkf(model, RigidMotions(model))

    def _of(self, inner):
        return State(inner, inner.x, inner.P, inner.tick)

    def start(self, x, P):
        return self._of(self.ekf.start(x, P))

    def predict(self, state, u):
        return self._of(self.ekf.predict(state.inner, u))

    def correct(self, state, measurements, inputs=()):
        return self._of(self.ekf.correct(state.inner, measurements, inputs))


class NoInterface(Right):
    def correct(self, state):
        return state


class Nan(Right):
    def correct(self, state, measurements, inputs=()):
        right = super().correct(state, measurements, inputs)
        return right._replace(x=right.x * np.nan) if state.tick == 50 else right


class Impure(Right):
    """Its answer hangs on how often it was asked."""

    calls = itertools.count()

    def predict(self, state, u):
        right = super().predict(state, u)
        return right._replace(x=right.x + 1e-13 * (next(self.calls) % 2))


class Mutating(Right):
    """It keeps its past in a list of its own, which earlier states share."""

    def correct(self, state, measurements, inputs=()):
        right = super().correct(state, measurements, inputs)
        state.x[0] += 1e-15
        return right._replace(x=right.x.copy())

    def _of(self, inner):
        return State(inner, inner.x.copy(), inner.P, inner.tick)


class Sharing(Right):
    """Every version of its state has the same list behind it."""

    def start(self, x, P):
        return super().start(x, P)._replace(inner=(self.ekf.start(x, P), []))

    def _with(self, inner, log):
        return self._of(inner)._replace(inner=(inner, log))

    def predict(self, state, u):
        inner, log = state.inner
        log.append(u)
        return self._with(self.ekf.predict(inner, u), log)

    def correct(self, state, measurements, inputs=()):
        inner, log = state.inner
        right = self._with(self.ekf.correct(inner, measurements, inputs), log)
        return right._replace(x=right.x + 1e-12 * len(log))


class Unordered(Right):
    """Weighs what came first the most."""

    def correct(self, state, measurements, inputs=()):
        right = super().correct(state, measurements, inputs)
        stamps = [s for s, _ in measurements]
        return right._replace(x=right.x + 1e-4) if stamps != sorted(stamps) else right


class Repeating(Right):
    """Uses what came twice twice: by a little less noise."""

    def correct(self, state, measurements, inputs=()):
        right = super().correct(state, measurements, inputs)
        stamps = [s for s, _ in measurements]
        return right._replace(x=right.x + 1e-4) if len(set(stamps)) < len(stamps) else right


class Late(Right):
    """Loses its way when a measurement is later than fifty ticks."""

    def correct(self, state, measurements, inputs=()):
        right = super().correct(state, measurements, inputs)
        late = any(state.tick - s > 50 for s, _ in measurements)
        return right._replace(x=right.x + 0.02) if late else right


class AnyStamp(Right):
    def correct(self, state, measurements, inputs=()):
        measurements = [each for each in measurements if 0 <= each.tick <= state.tick]
        return super().correct(state, measurements, inputs)


class NoOptimum(Right):
    """Does without every second measurement; so it claims more, which is right."""

    def correct(self, state, measurements, inputs=()):
        some = [each for each in measurements if each.tick % 2 or not 0 <= each.tick <= state.tick]
        return super().correct(state, some, inputs)


class Overconfident(Right):
    optimal = False

    def _of(self, inner):
        return State(inner, inner.x, inner.P / 4, inner.tick)


class Slow(Right):
    def correct(self, state, measurements, inputs=()):
        until = time.perf_counter() + self.seconds
        while time.perf_counter() < until:
            pass
        return super().correct(state, measurements, inputs)

    seconds = 0.0


class Admitting(Overconfident):
    admits = {"NEES": "we say so"}


class RightLaw:
    def __init__(self, goal):
        self.law = PolarLaw(goal, goal_tolerance=0.03)

    def drive(self, pose, time, memory):
        return self.law.drive(pose, time, memory)


class NoLaw(RightLaw):
    def drive(self, pose):
        return 0.0, 0.0, None


class Infinite(RightLaw):
    """Divides by the distance."""

    def drive(self, pose, time, memory):
        x, y, _ = pose
        rho = math.hypot(x - self.law.goal[0], y - self.law.goal[1])
        return min(1.0, 1 / rho), 0.0, None


class Dicing(RightLaw):
    def drive(self, pose, time, memory):
        v, omega, memory = super().drive(pose, time, memory)
        return v + random.random() * (abs(pose[2]) > 3), omega, memory


class Appending(RightLaw):
    """Remembers in a list that it never hands over."""

    def drive(self, pose, time, memory):
        v, omega, _ = super().drive(pose, time, None)
        memory = [] if memory is None else memory
        memory.append(v)
        return sum(memory), omega, memory


class RightPlant:
    """A unicycle."""

    def __init__(self, sample_time, start, seed):
        self.Ts, self.start, self.random = sample_time, start, np.random.default_rng(seed)
        self.pose, self.speeds = list(start), (0.0, 0.0)
        self.sense()

    def sense(self):
        self.seen = [a + 0.1 * self.random.standard_normal() for a in self.pose]

    def read(self):
        return (*self.pose, *self.seen, *self.speeds)

    def step(self, v, omega):
        x, y, theta = self.pose
        self.pose = [x + self.Ts * v * math.cos(theta), y + self.Ts * v * math.sin(theta),
                     theta + self.Ts * omega]
        self.speeds = v, omega
        self.sense()

    def place(self, x, y, theta):
        self.pose = [b if math.isnan(a) else a for a, b in zip((x, y, theta), self.start)]
        self.speeds = 0.0, 0.0
        self.sense()


class Plain(RightPlant):
    """Nobody tells it of NaN."""

    def place(self, x, y, theta):
        self.pose, self.speeds = [x, y, theta], (0.0, 0.0)
        self.sense()


class ShortReading(RightPlant):
    def read(self):
        return self.pose


class Unseeded(RightPlant):
    def __init__(self, sample_time, start, seed):
        super().__init__(sample_time, start, None)


class Stirring(RightPlant):
    def read(self):
        seen = super().read()
        self.sense()
        return seen


class Immovable(RightPlant):
    def place(self, x, y, theta):
        pass


class Degrees(RightPlant):
    def step(self, v, omega):
        super().step(v, math.degrees(omega))
        self.speeds = v, omega


def made_by_a_function(model):
    return Right(model)
'''

ROWS: list[tuple[Kind, str, str, str]] = [
    ("estimator", "NoInterface", "interface", "must be correct(state, measurements, inputs)"),
    ("estimator", "Nan", "interface", "must answer a finite array x"),
    ("estimator", "Impure", "pure", "predict answers twice differently"),
    ("estimator", "Mutating", "pure", "correct changes the state that it is given"),
    ("estimator", "Sharing", "pure", "calls that were made twice leave something behind"),
    ("estimator", "Unordered", "order", "another order"),
    ("estimator", "Repeating", "repeats", "repeated measurements make"),
    ("estimator", "Late", "delays", "60 ticks late"),
    ("estimator", "AnyStamp", "stamps", "tick -1 at tick 5 raises no StampError"),
    ("estimator", "NoOptimum", "optimum", "standard deviations from delayed-ekf"),
    ("estimator", "Overconfident", "NEES", "on average, not within"),
    ("law", "NoLaw", "interface", "must be drive(pose, time, memory)"),
    ("law", "Infinite", "finite", "ZeroDivisionError"),
    ("law", "Dicing", "deterministic", "twice differently"),
    ("law", "Appending", "memory", "asked again with its memory"),
    ("plant", "ShortReading", "interface", "must answer x, y, theta"),
    ("plant", "Unseeded", "deterministic", "the same seed gives other readings"),
    ("plant", "Stirring", "still", "two readings of one tick"),
    ("plant", "Immovable", "placing", "place(2.0, -1.0, 0.25)"),
    ("plant", "Degrees", "units", "it turns by"),
]


@pytest.fixture(scope="module")
def broken(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("broken")
    (folder / "broken_parts.py").write_text(BROKEN)
    return folder


@pytest.mark.parametrize("name", ESTIMATORS)
def test_the_estimators_that_ship_keep_the_interface_or_say_what_they_do_not(name: str) -> None:
    found = {finding.name: finding.held for finding in checked("estimator", name)}
    assert len(found) == 9
    admitted = [check for check, held in found.items() if held == "admitted"]
    assert admitted == list(ESTIMATORS[name].admits)
    assert "no" not in found.values()
    assert found["optimum"] == ("yes" if name == "delayed-ekf" else "-")


@pytest.mark.parametrize("name", LAWS)
def test_the_laws_that_ship_keep_the_interface(name: str) -> None:
    assert {finding.held for finding in checked("law", name)} == {"yes"}


@pytest.mark.parametrize("name", PLANTS)
def test_the_plants_that_ship_keep_the_interface(name: str) -> None:
    assert kind_of(name, None) == "plant"
    assert {finding.held for finding in checked("plant", name)} == {"yes"}


@pytest.mark.parametrize(
    ("kind", "name"), [("law", "RightLaw"), ("plant", "RightPlant"), ("plant", "Plain")]
)
def test_what_is_right_passes(
    broken: Path, monkeypatch: pytest.MonkeyPatch, kind: Kind, name: str
) -> None:
    monkeypatch.chdir(broken)
    assert {finding.held for finding in checked(kind, f"broken_parts:{name}")} == {"yes"}


@pytest.mark.parametrize(("kind", "name", "row", "said"), ROWS)
def test_each_way_to_break_it_fails_one_row(
    broken: Path, monkeypatch: pytest.MonkeyPatch, kind: Kind, name: str, row: str, said: str
) -> None:
    monkeypatch.chdir(broken)
    found = list(checked(kind, f"broken_parts:{name}"))
    (failed,) = (finding for finding in found if finding.held == "no")
    assert failed.name == row
    assert said in failed.said
    assert not all_hold(found)


def test_a_filter_that_is_too_slow_for_its_ticks(
    broken: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(broken)
    from laglab.check import estimator
    from laglab_control.estimators.family import estimator_kind

    slow = estimator_kind("broken_parts:Slow").make(estimator.MODEL)
    monkeypatch.setattr("broken_parts.Slow.seconds", 0.011)
    with pytest.raises(NotSoError, match="ms a tick, which lasts 10 ms"):
        estimator.cost(estimator.Subject(slow, optimal=True))


def test_what_is_admitted_fails_nothing(broken: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(broken)
    found = list(checked("estimator", "broken_parts:Admitting"))
    (admitted,) = (finding for finding in found if finding.held == "admitted")
    assert admitted.name == "NEES"
    assert admitted.said.startswith("we say so (NEES ")
    assert all_hold(found)


@pytest.fixture
def laglab_check(
    broken: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., tuple[int, str, str]]:
    """`laglab check ARGUMENTS`: exit code and what it says."""
    monkeypatch.chdir(broken)

    def call(*arguments: str) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as ended:
            main(["check", *arguments])
        assert isinstance(ended.value.code, int)
        return ended.value.code, *capsys.readouterr()

    return call


def test_the_command_says_it_in_a_table_and_an_exit_code(
    laglab_check: Callable[..., tuple[int, str, str]],
) -> None:
    code, out, _ = laglab_check("broken_parts:RightLaw")
    assert code == 0
    assert "broken_parts:RightLaw keeps the interface of a law" in out
    code, out, _ = laglab_check("broken_parts:Appending")
    assert code == 1
    assert "does not keep the interface of a law" in out
    assert [line.split()[1] for line in out.splitlines()[1:5]] == ["yes", "yes", "yes", "no"]
    assert laglab_check("broken_parts:RightPlant")[0] == 0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nobody"], "no estimator, law or plant 'nobody': take one of raw, ekf"),
        (["broken_parts:made_by_a_function"], "say which, with --as estimator|law|plant"),
        (["broken_parts:Nobody"], "broken_parts:Nobody: AttributeError"),
        (["nobody", "--as", "law"], "no law 'nobody': take one of polar, tracking"),
        (["polar", "--option", "gain"], "--option gain: must be KEY=VALUE"),
    ],
)
def test_what_cannot_be_checked_is_one_line(
    laglab_check: Callable[..., tuple[int, str, str]], arguments: list[str], said: str
) -> None:
    code, _, err = laglab_check(*arguments)
    assert code == 2
    (line,) = err.strip().splitlines()
    assert said in line


def test_options_that_it_does_not_have_fail_its_first_row(
    laglab_check: Callable[..., tuple[int, str, str]],
) -> None:
    for name, said in (
        ("broken_parts:RightLaw", "cannot be made: TypeError"),
        ("polar", "polar has none, so leave gain out"),
    ):
        code, out, _ = laglab_check(name, "--option", "gain=2")
        assert code == 1
        assert said in " ".join(out.split())


def test_speeds_that_are_not_finite_are_found() -> None:
    class Lost(PolarLaw):
        def drive(self, pose: Iterable[float], time: float, memory: object) -> Demand:
            far = math.hypot(*list(pose)[:2]) > 500 and time > 1
            return Demand(math.nan if far else 0.1, 0.0, memory)

    with pytest.raises(NotSoError, match="v = nan"):
        law.finite(Lost())


def test_the_kind_is_known_by_name_or_methods(
    broken: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(broken)
    for name, kind in (
        ("popf", "estimator"),
        ("polar", "law"),
        ("broken_parts:Right", "estimator"),
    ):
        assert kind_of(name, None) == kind
    assert kind_of("broken_parts:made_by_a_function", "estimator") == "estimator"
    with pytest.raises(ScenarioError):
        kind_of("broken_parts:made_by_a_function", None)
    with pytest.raises(PluginError):
        list(checked("law", "nobody"))


STUCK = """
import os, time


class Law:
    def __init__(self, goal):
        pass


class Sleeping(Law):
    def drive(self, pose, time_, memory):
        time.sleep(3600)


class Leaving(Law):
    def drive(self, pose, time_, memory):
        os._exit(7)
"""


def test_what_never_answers_or_ends_the_process_fails_its_row(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "stuck.py").write_text(STUCK)
    monkeypatch.chdir(tmp_path)
    kind, found = checked_apart(CheckOrder("stuck:Sleeping", None, ()), patience=4.0)
    assert kind == "law"
    assert found == [("interface", "no", "it did not answer within 4 s")]
    _, found = checked_apart(CheckOrder("stuck:Leaving", None, ()))
    (finding,) = found
    assert finding.name == "interface"
    assert finding.said == "the check's process ended with exit code 7 and no word"


def test_a_module_that_never_loads(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "endless.py").write_text("import time\ntime.sleep(3600)\n")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(LaglabError, match="it did not answer within 1 s") as raised:
        checked_apart(CheckOrder("endless:Law", None, ()), patience=1.0)
    assert raised.value.exit_code == 1
