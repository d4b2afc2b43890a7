"""Scenarios over all their keys: what is written reads back, and both sides take it."""

import math
import shutil
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from laglab.errors import ScenarioError
from laglab.runs.plant.shipped import robot_parameters
from laglab.runs.robot_side import gateway_config, link_fates, shown_parameters
from laglab.runs.station_side import station_config
from laglab.scenario import Scenario, changed, load
from laglab.scenario.keys import ANY, rows
from laglab.scenario.model import FILES
from laglab_control import ESTIMATORS, LAWS
from laglab_gateway.link.log import LINK_HEADER

Keys = dict[str, st.SearchStrategy[Any]]

HERE = st.floats(-600, 600)
POSE = st.tuples(HERE, HERE, st.floats(-1e9, 1e9)).map(list)
POSITIVE = st.floats(0, 1e300, exclude_min=True)
NOT_NEGATIVE = st.floats(0, 1e300)
PROBABILITY = st.floats(0, 1)
SHARE = st.floats(-1, 1, exclude_min=True, exclude_max=True)
TEXT = st.text(st.characters(exclude_categories=["Cs"]), max_size=30)
TICKS = st.integers(0, 65534)


def table(keys: Keys) -> st.SearchStrategy[dict[str, Any]]:
    """A table with some of the keys."""
    return st.fixed_dictionaries({}, optional=keys)


EXTRA_DELAY: Keys = {
    "distribution": st.sampled_from(["constant", "uniform", "normal", "exponential"]),
    "mean": NOT_NEGATIVE,
    "spread": NOT_NEGATIVE,
    "quantiles": st.lists(NOT_NEGATIVE, min_size=2, max_size=4).map(sorted),
    "correlation": st.floats(0, 1, exclude_max=True),
}
BY_A_TABLE = {"distribution": st.just("table"), "quantiles": EXTRA_DELAY["quantiles"]}
BURST: Keys = dict.fromkeys(("good_to_bad", "bad_to_good", "loss_good", "loss_bad"), PROBABILITY)
IMPAIRMENTS: Keys = {
    **dict.fromkeys(("loss", "reorder", "duplicate", "bit_error_rate"), PROBABILITY),
    "extra_delay": table(EXTRA_DELAY) | st.fixed_dictionaries(BY_A_TABLE),
    "burst": table(BURST),
    "reorder_by": NOT_NEGATIVE,
    "bandwidth": POSITIVE,
    "queue": st.integers(1, 10**9),
    "outages": st.lists(st.tuples(NOT_NEGATIVE, NOT_NEGATIVE).map(list), max_size=2),
}
EVENT: Keys = {
    "at": NOT_NEGATIVE,
    "duration": POSITIVE | st.just(math.inf),
    "link": table(IMPAIRMENTS),
    "direction": st.sampled_from(["command", "measurement", "both"]),
}
PLAYOUT: Keys = dict.fromkeys(("command", "measurement"), st.sampled_from([0, 65534]))
LINK: Keys = {
    "command_delay": TICKS,
    "measurement_delay": TICKS,
    "command": table(IMPAIRMENTS),
    "measurement": table(IMPAIRMENTS),
    "playout": table(PLAYOUT),
    "plan": st.integers(0, 240),
    "event": st.lists(table(EVENT), max_size=2),
    "replay": st.sampled_from(["link.csv", "./link.csv", "earlier run/link.csv"]),
}
PLANT_EVENT: Keys = {"at": st.floats(0, 1e6), "place": POSE}
THEIRS = st.from_regex(r"[A-Za-z_(][\w.\[\]() -]{0,12}", fullmatch=True)
INPUTS = ("v", "omega", "omega_left", "omega_right")
OUTPUTS = ("x", "y", "theta", "x_meas", "y_meas", "theta_meas")
START: Keys = dict.fromkeys(("x", "y", "theta"), THEIRS)
FOREIGN: Keys = {
    "fmu": st.sampled_from(["own.fmu", "./own.fmu", "robots/own.fmu"]),
    "inputs": st.fixed_dictionaries(dict.fromkeys(INPUTS[:2], THEIRS))
    | st.fixed_dictionaries(dict.fromkeys(INPUTS[2:], THEIRS)),
    "outputs": st.fixed_dictionaries(dict.fromkeys(OUTPUTS[:3], THEIRS))
    | st.fixed_dictionaries(dict.fromkeys(OUTPUTS, THEIRS)),
}
OF_FOREIGN: Keys = {
    "start": table(START).filter(bool),
    "parameters": st.dictionaries(
        THEIRS, st.integers(-9, 9) | HERE | st.booleans() | TEXT | st.lists(HERE), max_size=3
    ),
}
PLANT: Keys = {
    "fmi": st.sampled_from([2, 3]),
    "integration": st.sampled_from(["euler", "exact"]),
    "wheel_radius": POSITIVE,
    "track": POSITIVE,
    "wheel_noise_variance": NOT_NEGATIVE,
    "measurement_variance": st.tuples(POSITIVE, POSITIVE, POSITIVE).map(list),
    "event": st.lists(st.fixed_dictionaries(PLANT_EVENT), max_size=2),
}
TWO_WHEELS: Keys = {
    "wheel_speed_max": NOT_NEGATIVE,
    "motor_time_constant": NOT_NEGATIVE,
    "wheel_radius_error": SHARE,
    "track_error": SHARE,
    "wheel_slip": st.floats(0, 1, exclude_max=True),
}
BROUGHT: Keys = {
    "kind": st.sampled_from(["own:Robot", "installed"]),
    "options": st.dictionaries(
        THEIRS, HERE | st.dictionaries(THEIRS, TEXT, min_size=1, max_size=2), max_size=3
    ),
}
ANY_PLANT = (
    table(PLANT | TWO_WHEELS)
    | st.fixed_dictionaries(FOREIGN, optional=OF_FOREIGN | PLANT)
    | st.fixed_dictionaries({"kind": BROUGHT.pop("kind")}, optional=BROUGHT | PLANT)
)
ESTIMATOR: Keys = {
    "kind": st.sampled_from(list(ESTIMATORS)),
    "compare": st.lists(st.sampled_from([name for name in ESTIMATORS if name != "raw"])),
    "initial_covariance": st.floats(0, 1.0),
    "initial_estimate": POSE | st.sampled_from(["start", "drawn"]),
    "guard": st.booleans(),
    "options": st.dictionaries(THEIRS, HERE | TEXT, max_size=2),
}
LAW: Keys = dict.fromkeys(
    (
        *("gamma", "lambda", "h", "goal_tolerance"),
        *("v_max", "omega_max", "caution", "accel_max", "alpha_max"),
    ),
    POSITIVE,
)
WITH_A_PATH: Keys = {
    "kind": st.sampled_from(["tracking", "somebodys:Law"]),
    "path": st.sampled_from(["circle(1, 0.5)", "eight( 3,2 )", "way.csv", "earlier run/way.csv"]),
    "options": st.dictionaries(
        st.sampled_from(["k_x", "k_y"]), st.floats(0.1, 9) | st.lists(st.floats(0, 1)), max_size=2
    ),
}
SAFETY: Keys = {
    **dict.fromkeys(("v_limit", "omega_limit"), POSITIVE),
    **dict.fromkeys(("link_timeout", "ramp"), NOT_NEGATIVE),
}
ORIGIN: Keys = {
    "latitude": st.floats(-89, 89),
    "longitude": st.floats(-180, 180),
    "altitude": st.floats(-1000, 10000),
}
TOP: Keys = {
    "name": TEXT,
    "description": TEXT,
    "start": st.tuples(st.floats(-50, 50), st.floats(-50, 50), HERE).map(list),
    "goal": st.tuples(st.floats(-50, 50), st.floats(-50, 50), HERE).map(list),
    "duration": st.floats(1.0, 1e6) | st.just(math.inf),
    "sample_time": st.floats(1e-3, 1.0),
    "seed": st.integers(0, 2**31 - 1),
    "noise": st.booleans(),
    "pace": st.sampled_from(["lockstep", "realtime"]),
    "speed": POSITIVE,
    "silence_timeout": POSITIVE,
    "plant": ANY_PLANT,
    "estimator": table(ESTIMATOR),
    "law": table(LAW) | st.fixed_dictionaries(WITH_A_PATH, optional=LAW),
    "link": table(LINK),
    "safety": table(SAFETY),
    "origin": table(ORIGIN),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With what the scenarios refer to."""
    folder = tmp_path_factory.mktemp("scenarios")
    for log in (folder / "link.csv", folder / "earlier run" / "link.csv"):
        log.parent.mkdir(exist_ok=True)
        log.write_text(LINK_HEADER + "command,0,0,0,35,delivered,0.01\n")
    for way in (folder / "way.csv", folder / "earlier run" / "way.csv"):
        way.write_text("time,x,y,theta,v,omega\n0,0,0,0,0,0\n")
    return folder


def at(folder: Path, fields: dict[str, Any]) -> Scenario:
    """The scenario whose file stands in that folder."""
    files = {
        f"{table}.{key}": str(folder / path)
        for table, key in FILES
        if (path := fields.get(table, {}).get(key))
    }
    path = fields.get("law", {}).get("path", "")
    files |= {"law.path": str(folder / path)} if path.endswith("csv") else {}
    return changed(Scenario(), {**fields, **files})


def test_the_strategies_know_every_key() -> None:
    known = {
        *TOP,
        *(
            f"plant.{key}"
            for key in (*PLANT, *TWO_WHEELS, *FOREIGN, *OF_FOREIGN, "kind", "options")
        ),
        *(f"plant.inputs.{key}" for key in INPUTS),
        *(f"plant.outputs.{key}" for key in OUTPUTS),
        *(f"plant.start.{key}" for key in START),
        *(f"estimator.{key}" for key in ESTIMATOR),
        *(f"law.{key}" for key in {**LAW, **WITH_A_PATH}),
        *(f"link.{key}" for key in LINK),
        *(f"link.playout.{key}" for key in PLAYOUT),
        *(f"safety.{key}" for key in SAFETY),
        *(f"origin.{key}" for key in ORIGIN),
        *(f"link.event.{ANY}.{key}" for key in EVENT),
        *(f"plant.event.{ANY}.{key}" for key in (*PLANT_EVENT, "by")),
    }
    for link in ("link.command", "link.measurement", f"link.event.{ANY}.link"):
        known |= {f"{link}.{key}" for key in IMPAIRMENTS}
        known |= {f"{link}.burst.{key}" for key in BURST}
        known |= {f"{link}.extra_delay.{key}" for key in EXTRA_DELAY}
    assert known == {row.place for row in rows()}


@settings(max_examples=150)
@given(table(TOP))
def test_what_is_written_reads_back_to_the_same(folder: Path, fields: dict[str, Any]) -> None:
    scenario, file = at(folder, fields), folder / "written.toml"
    for place in (folder, None):
        file.write_text(scenario.to_toml(place), encoding="utf-8", newline="")
        assert load(str(file)) == scenario


@settings(max_examples=50)
@given(table(TOP))
def test_what_a_scenario_allows_both_sides_take(folder: Path, fields: dict[str, Any]) -> None:
    told = {table: {**fields.get(table, {}), "options": {}} for table in ("estimator", "law")}
    scenario = at(folder, fields | told)
    if scenario.law.kind in LAWS:
        station_config(scenario)
    gateway_config(scenario)
    link_fates(scenario)
    shown_parameters(scenario)
    assert robot_parameters(scenario).by_name()["integration"] in (1, 2)


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("", "tells of no frame"),
        ("measurement,0,0,0,35,delivered,nan\n", "measurement 0 of tick 0: extra must be"),
    ],
)
def test_a_log_of_which_nothing_can_be_replayed_is_refused(
    tmp_path: Path, rows: str, said: str
) -> None:
    log = tmp_path / "link.csv"
    log.write_text(LINK_HEADER + rows)
    with pytest.raises(ScenarioError, match=f"link.replay: .*{said}"):
        load("lab", {"link.replay": str(log)})


def test_a_path_is_relative_to_the_file_it_stands_in(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(folder, tmp_path / "logs")
    own = tmp_path / "own" / "scenario.toml"
    own.parent.mkdir()
    own.write_text('link.replay = "../logs/link.csv"\n')
    monkeypatch.chdir(tmp_path / "own")
    scenario = load("scenario.toml")
    assert scenario.link.replay == (tmp_path / "logs" / "link.csv").resolve()
    assert load(str(own)) == scenario
    assert 'replay = "../logs/link.csv"' in scenario.to_toml(own.parent)
    assert 'replay = "logs/link.csv"' in scenario.to_toml(tmp_path)
    assert load("fig6", {"link.replay": "../logs/link.csv"}).link == scenario.link
