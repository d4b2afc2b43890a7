"""The oldest versions of what laglab needs, as pyproject.toml names them, do."""

import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from .environments import Environment

PYPROJECT = Path(__file__).parents[2] / "pyproject.toml"
PROJECT = tomllib.loads(PYPROJECT.read_text("utf-8"))["project"]
EXTRAS = ("run", "see", "conform", "export", "link", "study")
STUDY = """
scenario = "lab"
seeds = 2
[grid]
"link.command_delay" = [0, 2]
"estimator.kind" = ["popf", "delayed-ekf"]
"""
COMMANDS = """
run lab --duration 1 --transport serial --out serial
run lab-car --duration 1 --out car
run lab-radio --duration 1 --transport udp --out radio
report fig6 radio --out both.html
compare fig6 radio --out both.png
figure fig6 --out figure.pdf
animate serial radio
export radio --format mcap
export fig6 --format parquet
export fig6 --format mat
replay radio/robot.tlog --estimator delayed-ekf
sweep small.toml --set duration=1.0 --out study
map study
protocol lint
protocol generate --lang C generated
protocol install
conform --self-test
"""


def users_requirements() -> Iterator[str]:
    """What laglab and the extras for its users need, without what they need of each other."""
    optional = PROJECT["optional-dependencies"]
    everything = [*PROJECT["dependencies"]]
    for extra in (*EXTRAS, "controller", "gateway"):
        everything += optional[extra]
    yield from (each for each in everything if not each.startswith("laglab["))


def test_every_requirement_has_a_lower_bound_and_no_other() -> None:
    for requirement in users_requirements():
        _, bound, version = requirement.partition(">=")
        assert bound, requirement
        assert not set("<,!~;") & set(version), requirement
    for_users = PROJECT["optional-dependencies"].keys() - {"docs", "fuzz", "test"}
    assert for_users == {*EXTRAS, "controller", "gateway"}


@pytest.mark.slow
@pytest.mark.timeout(1500)
def test_the_oldest_that_are_allowed_do(
    wheel: Path,
    pythons: dict[tuple[int, int], str],
    environment: Callable[[str], Environment],
    here: Callable[[str], str],
    tmp_path: Path,
) -> None:
    """On the oldest Python here: the newer ones have no wheels of the oldest versions."""
    oldest = environment(pythons[min(pythons)])
    bounds = oldest.folder / "bounds.txt"
    bounds.write_text("\n".join(each.replace(">=", "==") for each in users_requirements()))
    oldest.install("-c", str(bounds), f"laglab[{','.join(EXTRAS)}] @ {wheel.as_uri()}")
    (oldest.folder / "small.toml").write_text(STUDY)
    for command in ("run fig6 --out fig6", *COMMANDS.strip().splitlines()):
        oldest.laglab(command)
    oldest.imports("laglab.link.importing.captures")
    here("run fig6 --out fig6")
    traces = [folder / "fig6" / "trace.csv" for folder in (oldest.folder, tmp_path)]
    assert traces[0].read_bytes() == traces[1].read_bytes()
