"""``laglab scenario``, and what is generated from the same source."""

import json
import math
import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from laglab.scenario import Scenario, load, shipped
from laglab.scenario.explain import explained, spelled
from laglab.scenario.keys import rows
from laglab.scenario.reference import GENERATED, schema

Printed = Callable[..., str]
REFERENCE = Path(__file__).parents[2] / "docs" / "reference"
UNITS = {
    "-", "1", "s", "ticks", "m", "m/s", "rad/s", "m/s²", "rad/s²", "1/s", "m, m, rad",
    "m², m², rad²", "(rad/s)²", "bit/s", "byte", "deg",
}  # fmt: skip


@pytest.fixture
def printed(ended: Callable[..., Any]) -> Printed:
    """What ``laglab scenario ARGUMENTS`` prints."""

    def call(*arguments: str) -> str:
        code, out, err = ended("scenario", *arguments)
        assert (code, err) == (0, "")
        return str(out)

    return call


def shown(text: str, place: str) -> str:
    """The value of a dotted key in an explanation."""
    (line,) = [line for line in text.splitlines() if line.startswith(f"{place} = ")]
    return line.removeprefix(f"{place} = ")


@pytest.mark.parametrize("name", ["fig8", "lab-radio"])
def test_it_prints_a_file_that_reads_back(printed: Printed, name: str, tmp_path: Path) -> None:
    (tmp_path / "again.toml").write_text(printed(name))
    assert load(str(tmp_path / "again.toml")) == load(name)


def test_set_beats_the_file_and_an_option_of_its_own_beats_set(printed: Printed) -> None:
    told = ("--set", "link.command_delay=3", "--set", "link.measurement_delay = 4", "-n", "5")
    text = printed(
        "fig6", *told, "--set", "estimator.kind=ekf", "--set", "link={}", "--set", "seed=7"
    )
    file = tomllib.loads(text)
    assert (file["link"]["command_delay"], file["link"]["measurement_delay"]) == (5, 20)
    assert (file["estimator"]["kind"], file["seed"]) == ("ekf", 7)


def test_every_option_says_what_its_key_says(printed: Printed) -> None:
    options = {
        "-n": ("link.command_delay", "3"),
        "-m": ("link.measurement_delay", "4"),
        "--start": ("start", "1.0,2.0,3.0"),
        "--goal": ("goal", "1.0,2.0,3.0"),
        "--seed": ("seed", "5"),
        "--duration": ("duration", "inf"),
        "--estimator": ("estimator.kind", "ekf"),
        "--p0": ("estimator.initial_covariance", "0.5"),
        "--initial-estimate": ("estimator.initial_estimate", "drawn"),
        "--v-max": ("law.v_max", "1.5"),
        "--omega-max": ("law.omega_max", "1.5"),
        "--goal-tolerance": ("law.goal_tolerance", "0.1"),
        "--pace": ("pace", "realtime"),
        "--speed": ("speed", "2.0"),
        "--silence": ("silence_timeout", "1.0"),
        "--fmi": ("plant.fmi", "2"),
    }
    usual = printed("fig6")
    for option, (key, value) in options.items():
        assert usual != printed("fig6", option, value) == printed("fig6", "--set", f"{key}={value}")
    assert printed("fig6", "--noise") == printed("fig6", "--set", "noise=true")


def test_the_first_estimator_drives_and_the_others_are_compared(printed: Printed) -> None:
    text = printed(
        "fig6", "--estimator", "popf", "--estimator", "ekf", "--estimator", "delayed-ekf"
    )
    assert tomllib.loads(text)["estimator"]["kind"] == "popf"
    assert tomllib.loads(text)["estimator"]["compare"] == ["ekf", "delayed-ekf"]


@pytest.mark.parametrize("name", ["fig6", "lab-radio"])
def test_explained_every_key_has_value_unit_default_and_sentence(name: str) -> None:
    scenario = load(name, {"description": "long " * 40})
    text = explained(scenario)
    assert max(map(len, text.splitlines())) < 80
    joined = " ".join(text.split())
    for place, key, value in rows(scenario):
        if key.table is None:
            told = f"[{key.unit}] {key.sentence} Default: {spelled(key.default)}."
            assert f"{place} = {' '.join(spelled(value).split())} {told}" in joined
        else:
            assert f"[{place}]" in text
            assert key.sentence in joined


def test_explained_tells_what_is_set_and_what_is_not(printed: Printed) -> None:
    text = printed("lab-radio", "--explain", "--set", "law.v_max=2.5")
    assert shown(text, "law.v_max") == "2.5"
    assert shown(text, "safety.v_limit") == "not set"
    assert shown(text, "link.event.0.link.loss") == "1.0"
    assert shown(text, "link.command.burst.loss_bad") == "not set"
    assert shown(text, "link.measurement.burst.loss_bad") == "1.0"
    assert shown(printed("fig6", "--explain"), "link.event.N.duration") == "not set"


def test_a_reader_that_has_had_enough_sees_no_traceback() -> None:
    command = [sys.executable, "-m", "laglab", "scenario", "lab", "--explain"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        assert process.stderr.read() == b""


def test_every_key_has_a_unit_a_sentence_and_a_default() -> None:
    for place, key, _ in rows():
        assert key.unit in UNITS, place
        assert key.sentence.endswith("."), place
        assert "default" not in repr(key.default).lower(), f"{place} has none"
        numbers = key.default if isinstance(key.default, tuple) else (key.default,)
        if any(isinstance(n, int | float) and not isinstance(n, bool) for n in numbers):
            assert key.unit != "-", place


def test_the_page_and_the_schema_tell_every_key() -> None:
    page, made = GENERATED["scenario.md"](), json.loads(schema())
    for place, key, _ in rows():
        assert f"| `{key.name}` | {key.unit} | " in page, place
        told = _at(made, place.split("."))
        assert told["description"].startswith(key.sentence)
        assert key.unit == "-" or told["description"].endswith(f" [{key.unit}]")


def _at(made: dict, path: list[str]) -> dict:
    """The schema at a dotted key."""
    node = made
    for part in path:
        node = node.get("items", node) if part == "N" else node
        while "$ref" in node:
            node = made["$defs"][node["$ref"].rpartition("/")[2]]
        node = node if part == "N" else node["properties"][part]
    return node


def test_the_schema_is_one_and_takes_what_we_take(printed: Printed) -> None:
    made = json.loads(printed("--schema"))
    Draft202012Validator.check_schema(made)
    validator = Draft202012Validator(made)
    for scenario in [Scenario(), *shipped().values(), load("lab", {"duration": math.inf})]:
        validator.validate(scenario.fields())


@pytest.mark.parametrize(
    "wrong",
    [
        {"colour": "red"},
        {"link": {"comand_delay": 3}},
        {"link": {"command_delay": -1}},
        {"link": {"command": {"loss": 7}}},
        {"link": {"event": [{"direction": "up"}]}},
        {"estimator": {"kind": 5}},
        {"estimator": {"compare": ["raw"]}},
        {"start": [1.0, 2.0]},
        {"law": {"gamma": 0}},
        {"noise": "yes"},
    ],
    ids=str,
)
def test_the_schema_refuses_what_we_refuse(wrong: dict[str, object]) -> None:
    assert not Draft202012Validator(json.loads(schema())).is_valid(wrong)


@pytest.mark.parametrize("text", ["", "# nothing yet\n", 'description = "mine"\n'])
def test_an_empty_file_says_what_it_runs_as_and_runs(
    tmp_path: Path, text: str, ended: Callable[..., Any]
) -> None:
    own = tmp_path / "own.toml"
    own.write_text(text)
    options = ("-n", "7", "--duration", "0.1", "--transport", "inline")
    done = ended("run", own, *options, "--out", tmp_path / "run")
    assert done.code == 0
    said = f"{own} sets nothing, so it runs by default: popf, n = 7, m = 20, noise off"
    assert [line for line in done.err.splitlines() if "own.toml" in line] == [said]


def test_whoever_says_something_is_not_told(printed: Printed, tmp_path: Path) -> None:
    (tmp_path / "own.toml").write_text("seed = 2\n")
    assert "seed = 2" in printed(str(tmp_path / "own.toml"))
