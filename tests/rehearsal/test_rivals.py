"""The ways to live with a link, beside each other."""

import re
import shlex
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import laglab
from laglab.runs.robot_side import link_fates
from laglab.scenario import Scenario
from laglab.studies.rivals import (
    LINKS,
    OWN_LINK,
    STRATEGIES,
    Fared,
    Trial,
    bounds,
    links_of,
    scores,
    trials,
    tried,
)

ROOT = Path(__file__).parents[2]


def scenario_of(link: str, strategy: str, base: str = "lab", **keys: object) -> Scenario:
    (trial,) = trials(laglab.load(base, keys), [link], [strategy], seeds=1)
    return Scenario.from_toml(trial.scenario)


def test_the_command_leaves_table_and_picture(
    tmp_path: Path, ended: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    options = ["--seeds", "1", "--on", "ideal", "--on", "outages", "--workers", "1"]
    chosen = ["--only", "raw", "--only", "plans", "--only", "guarded", "--out", "met.pdf"]
    code, out, _ = ended("rivals", "lab", *options, *chosen)
    assert code == 0
    lines = out.splitlines()
    assert lines[0].split() == ["lab,", "n", "=", "10,", "m", "=", "20,", "1", "run", "each"]
    assert "settled [s] RMS [m] driven [m]" in lines[1]
    rows = [line.split() for line in lines if line.endswith(tuple("0123456789"))]
    raw, plans, guarded, *_ = (row[-5:] for row in rows)
    assert raw[:3] == ["raw", "0%", "-"]
    assert plans[1:] == guarded[1:]  # on an ideal link
    assert guarded[1] == "100%"
    assert (tmp_path / "met.pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.parametrize("link", list(LINKS))
@pytest.mark.parametrize("strategy", list(STRATEGIES))
def test_every_strategy_can_be_run_on_every_link(link: str, strategy: str) -> None:
    scenario = scenario_of(link, strategy, "lab-radio", seed=7)
    assert scenario.seed == 7
    assert bool(link_fates(scenario)) == (link != "ideal")
    assert scenario.estimator.guard is (strategy in ("guarded", "play-out", "plans"))
    assert (scenario.link.plan > 0) == (strategy == "plans")
    assert (scenario.link.playout.command > 0) == (strategy == "play-out")
    assert scenario.estimator.initial_covariance == (1e-4 if strategy == "popf" else 1e-3)


def test_the_scenarios_own_link_takes_part_if_it_is_not_ideal(tmp_path: Path) -> None:
    assert OWN_LINK not in links_of(laglab.load("lab"))
    own = scenario_of(OWN_LINK, "plans", "lab-radio")
    assert own.link.command == laglab.load("lab-radio").link.command
    laglab.run("lab", {"duration": 1.0, "link.command.loss": 0.5}, out=tmp_path / "run")
    recorded = {"link.replay": str(tmp_path / "run" / "link.csv")}
    imported = scenario_of(OWN_LINK, "play-out", **recorded)
    assert imported.link.replay == tmp_path / "run" / "link.csv"
    assert scenario_of("loss", "plans", **recorded).link.replay is None


def test_the_bounds_are_those_by_which_nearly_all_are_there() -> None:
    jitter = {"distribution": "exponential", "mean": 0.04}  # 99 % within 0.184 s
    link = {"link.command.extra_delay": jitter, "duration": 60.0}
    untouched = {"link.playout.measurement": 20}
    found = bounds(laglab.load("lab", link))
    assert found == {"link.playout.command": pytest.approx(29, abs=1), **untouched}
    done = laglab.run("lab", {"duration": 20.0, "link.command.extra_delay": jitter, **found})
    assert done.summary.link is not None
    assert 0 < done.summary.link.command.lost["late"] < 0.02 * 2000


def test_what_diverges_or_never_settles_is_told_as_that() -> None:
    def outcome(strategy: str, **keys: object) -> Fared:
        short = laglab.load("fig8", {"duration": 3.0, **keys})
        return tried(Trial("ideal", strategy, short.to_toml()))

    lost = outcome("popf", **{"estimator.kind": "popf", "estimator.initial_covariance": 5e-3})
    assert (lost.converged, lost.settled) == (False, None)
    raw = outcome("raw", **{"estimator.kind": "raw"})
    assert (raw.rms, raw.converged) == (None, False)
    assert raw.driven > 1.0


def test_the_scores_are_those_of_the_runs() -> None:
    def one(converged: bool, settled: float | None, rms: float, driven: float) -> Fared:
        return Fared("loss", "plans", converged, settled, rms, driven)

    runs = [one(True, 4.0, 0.03, 5.0), one(True, 6.0, 0.04, 4.0), one(False, None, 0.0, 9.0)]
    score = scores(runs)["loss", "plans"]
    assert (score.runs, score.converged, score.settled, score.driven) == (3, 2, 5.0, 5.0)
    assert score.rms == pytest.approx((0.0025 / 3) ** 0.5)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--on", "nonsense"), "--on: 'nonsense' is not one of ideal, jitter"),
        (("--on", OWN_LINK), "--on: 'its own' is not one of"),
        (("--only", "nonsense"), "--only: 'nonsense' is not one of raw, popf"),
        (("--out", "picture.nonsense"), "--out picture.nonsense"),
        (("--duration", "inf"), "duration: must be finite here"),
        (("--duration", "inf", "--on", "loss", "--only", "plans"), "duration: must be finite here"),
        (("--pace", "realtime"), "pace: must be lockstep here"),
        (("--set", "plant.kind=nope"), "no plant 'nope'"),
        (("--set", "law.kind=nope"), "law.kind: must be one of polar"),
    ],
)
def test_what_cannot_be_is_one_line(
    options: tuple[str, ...], said: str, refused: Callable[..., str]
) -> None:
    assert said in refused("rivals", "lab", *options)


@pytest.mark.slow
def test_each_command_of_its_page_works(
    tmp_path: Path, ended: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    laglab.run("lab", {"duration": 1.0, "link.command.loss": 0.5}, out=tmp_path / "run")
    (tmp_path / "run" / "link.csv").rename(tmp_path / "link.csv")
    page = (ROOT / "docs" / "rivals.md").read_text(encoding="utf-8")
    commands = re.findall(r"^    laglab (.*)$", page, flags=re.M)
    assert len(commands) == 2
    for command in commands:
        small = ["--seeds", "1", "--duration", "2", "--only", "plans"]
        assert ended(*shlex.split(command), *small).code == 0, command
        assert (tmp_path / "rivals.png").read_bytes().startswith(b"\x89PNG")
